#include "timbre/analysis/spectrum/detail/block_lanczos.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/matrix_product.h"
#include "timbre/analysis/spectrum/detail/row_pieces.h"

namespace timbre::detail {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

BlockLanczos::BlockLanczos(const ShiftedFactor& factor, LanczosOptions options)
    : factor_(factor),
      options_(std::move(options)),
      mass_(factor.pencil(), options_.threads),
      basis_(mass_, options_.width, best_instruction_set(), options_.threads),
      locked_(mass_, options_.width, best_instruction_set(), options_.threads),
      Z_(basis_.numbers()),
      projected_(options_.width) {}

void BlockLanczos::solve(double* X) {
  const PhaseClock::Scope phase(options_.clock, &SpectrumPhases::solves);
  factor_.solve_in_factor_order(X, options_.width);
  if (options_.on_solve) options_.on_solve(options_.width);
}

// One step of inverse iteration on random vectors that have a share of every unknown.
void BlockLanczos::write_random(double* U) {
  std::mt19937_64 random(memory_.seed++);
  for (int i = 0; i < mass_.size(); ++i) {
    const double scale = std::sqrt(std::abs(mass_.diagonal(i)));
    double* const row = U + at(i) * at(options_.width);
    for (int c = 0; c < options_.width; ++c) {
      row[c] = scale * (static_cast<double>(random() >> 11U) * 0x1p-53 - 0.5);
    }
  }
  solve(U);
}

void BlockLanczos::start() {
  const PhaseClock::Scope phase(options_.clock, &SpectrumPhases::orthogonalization);
  basis_.clear();
  projected_.clear();
  full_passes_only_ = false;
  largest_ = 0.0;
  drift_ = 0.0;
  double* const U = basis_.next();
  write_random(U);
  for (int pass = 0; pass < 2; ++pass) {
    const Square gram = locked_.subtract(locked_.products(U, 0), U, 0);
    (void)basis_.orthonormalize(gram, VectorXd::Zero(options_.width), U, Z_.data());
  }
  basis_.append_next();
}

// Columns of U that are nothing beside the others become random ones, as at the start, without a
// coupling: so further copies of multiple eigenvalues are found.
void BlockLanczos::write_random_columns(const std::vector<int>& columns, double* U) {
  double* const random = Z_.data();
  write_random(random);
  const int P = options_.width;
  for (int i = 0; i < mass_.size(); ++i) {
    for (const int c : columns) U[at(i) * at(P) + at(c)] = random[at(i) * at(P) + at(c)];
  }
}

// Z holds M V_j. What the recurrence knows is taken off first, so that one pass over all blocks is
// enough: it only removes rounding.
void BlockLanczos::step() {
  const PhaseClock::Scope phase(options_.clock, &SpectrumPhases::orthogonalization);
  constexpr int kPeriod = 3;
  constexpr int kPasses = 6;
  constexpr double kMostDrift = 1e-5;
  constexpr double kNothing = 1e-11;  // what rounding leaves of a vector inside the basis
  const int P = options_.width;
  const int j = basis_.blocks() - 1;
  double* const U = basis_.next();
  basis_.copy(Z_.data(), U);
  solve(U);
  Square diagonal = basis_.subtract_last_but_one(last_factor_.transpose(), Z_.data(), U);

  const bool is_skipped =
      j >= 4 && j % kPeriod == kPeriod - 1 && locked_.blocks() == 0 && !full_passes_only_;
  int first = is_skipped ? j - 1 : 0;
  Square H = basis_.subtract_last(diagonal, U, first);
  diagonal += H.bottomRows(P);
  largest_ = std::max(largest_, diagonal.cwiseAbs().maxCoeff());
  Square coupling = Square::Identity(P, P);
  VectorXd least = VectorXd::Constant(P, kNothing * largest_);
  bool is_done = false;
  for (int pass = 0; pass < kPasses && !is_done; ++pass) {
    if (pass > 0) H = basis_.products(U, first);
    Square gram = basis_.subtract(H, U, first);
    VectorXd removed = H.cwiseAbs().colwise().maxCoeff();
    if (locked_.blocks() > 0) {
      const Square of_locked = locked_.products(U, 0);
      gram = locked_.subtract(of_locked, U, 0);
      removed = removed.cwiseMax(of_locked.cwiseAbs().colwise().maxCoeff().transpose());
    }
    const BlockFactor factor = basis_.orthonormalize(gram, least, U, Z_.data());
    coupling = factor.R * coupling;
    const VectorXd left = factor.R.diagonal();
    std::vector<int> nothing;
    for (int c = 0; c < P; ++c) {
      if (left[c] == 0.0) nothing.push_back(c);
      // Beside what the columns are now; those that are random have no coupling.
      least[c] = coupling(c, c) > 0.0 ? kNothing * largest_ / coupling(c, c) : 0.0;
    }
    if (!nothing.empty()) {
      write_random_columns(nothing, U);
      first = 0;
      continue;
    }
    if (pass == 0 && first == 0 && j >= 4) {
      drift_ = std::max(drift_, removed.cwiseQuotient(left).maxCoeff());
    }
    is_done = factor.smallest_pivot > 1e-6 && (removed.array() < 1e3 * left.array()).all();
  }
  if (!is_done) {
    throw Error(ErrorKind::not_converged, "", "spectrum", "no vectors are left outside the basis");
  }
  if (drift_ > kMostDrift) full_passes_only_ = true;
  projected_.append(last_factor_, Square(0.5 * (diagonal + diagonal.transpose())));
  last_factor_ = coupling;
  basis_.append_next();
}

bool BlockLanczos::try_goal(double shift, const BandGoal& goal, BandPairs& found, int& missing) {
  const PhaseClock::Scope phase(options_.clock, &SpectrumPhases::projection);
  small_ = timbre::detail::solve(projected_);
  const auto m = small_.values.size();
  const MatrixXd tails = last_factor_ * small_.vectors.bottomRows(options_.width);
  std::vector<std::pair<double, int>> below;
  std::vector<std::pair<double, int>> above;
  std::vector<double> errors(static_cast<std::size_t>(m));
  for (Index i = 0; i < m; ++i) {
    const double theta = small_.values[i];
    // The residual of the purified vector in the norm of the inverse mass.
    errors[static_cast<std::size_t>(i)] = tails.col(i).norm() / (theta * theta);
    (theta < 0.0 ? below : above).emplace_back(shift + 1.0 / theta, static_cast<int>(i));
  }
  std::sort(below.rbegin(), below.rend());
  std::sort(above.begin(), above.end());
  const auto has_converged = [&](const std::pair<double, int>& pair) {
    return errors[at(pair.second)] <=
           goal.tolerance * (std::abs(pair.first) + std::max(goal.scale, std::abs(shift)));
  };
  const auto end_below = std::find_if_not(below.begin(), below.end(), has_converged);
  const auto at_cut =
      std::find_if(below.begin(), end_below, [&](const auto& p) { return p.first <= goal.cut; });
  const auto end_above = std::find_if_not(above.begin(), above.end(), has_converged);

  found = {};
  found.left = static_cast<int>(at_cut - below.begin());
  found.right = static_cast<int>(end_above - above.begin());
  found.sees_the_cut = at_cut != end_below || end_below == below.end();
  chosen_.clear();
  for (auto pair = at_cut; pair != below.begin();) chosen_.push_back((--pair)->second);
  for (auto pair = above.begin(); pair != end_above; ++pair) chosen_.push_back(pair->second);
  for (const int i : chosen_) found.values.push_back(shift + 1.0 / small_.values[i]);
  missing = std::max(goal.left - found.left, goal.right - found.right);
  const bool is_beyond_hope = found.sees_the_cut && found.left < goal.left;
  return missing <= 0 || (is_beyond_hope && found.right >= goal.right);
}

BandPairs BlockLanczos::run(double shift, const BandGoal& goal) {
  const int P = options_.width;
  start();
  // Fitted on closed surfaces; what a run needed guides the next one.
  const double usual = 5.5 * P + 30.0 + 3.2 * std::max(goal.left, goal.right);
  int tests = 0;
  BandPairs found =
      search(shift, goal, std::max(2, static_cast<int>(memory_.basis_share * usual / P)), tests);
  memory_.basis_share = std::clamp(memory_.basis_share * (tests > 1 ? 1.02 : 0.97), 0.6, 2.0);
  return found;
}

BandPairs BlockLanczos::go_on(double shift, const BandGoal& goal) {
  int tests = 0;
  return search(shift, goal, basis_.blocks(), tests);
}

BandPairs BlockLanczos::search(double shift, const BandGoal& goal, int next_test, int& tests) {
  // The last dimensions beside what is locked are not independent to rounding.
  const int room = (mass_.size() / options_.width - locked_.blocks()) * 3 / 4;
  const int most = std::min(options_.most_blocks + 1, room);
  const auto is_at_end = [&] { return basis_.blocks() >= most; };
  for (BandPairs found;;) {
    if (!is_at_end()) step();
    const int steps = basis_.blocks() - 1;
    if (steps < next_test && !is_at_end()) continue;
    if (steps == 0) return found;  // what is locked leaves no room
    ++tests;
    int missing = 0;
    if (try_goal(shift, goal, found, missing) || is_at_end()) return found;
    next_test = steps + 1 + static_cast<int>(1.8 * missing / options_.width);
  }
}

// Of the basis and the block after it: the part beyond the basis is one more application of the
// inverse, which costs nothing here (purification, Ericsson and Ruhe 1980).
MatrixXd BlockLanczos::coefficients(int first, int count) const {
  const int P = options_.width;
  const Index m = small_.values.size();
  MatrixXd C(m + P, count);
  for (int k = 0; k < count; ++k) {
    const int i = chosen_[at(first + k)];
    C.col(k).head(m) = small_.vectors.col(i);
    C.col(k).tail(P) = last_factor_ * small_.vectors.col(i).tail(P) / small_.values[i];
    C.col(k) /= C.col(k).norm();
  }
  return C;
}

// Calls `write(row, vectors)` for all rows, some at a time, on several threads; vectors are
// rows x count.
template <typename Write>
void BlockLanczos::for_each_rows(const MatrixXd& coefficients, Write write) const {
  constexpr int kRows = 256;
  const int P = options_.width;
  for_each_piece(mass_.size(), options_.threads, [&](int, int begin, int end) {
    MatrixXd packed(coefficients.rows(), kRows);
    for (int row = begin; row < end; row += kRows) {
      const int rows = std::min(kRows, end - row);
      for (int j = 0; j < basis_.blocks(); ++j) {
        const double* const block = basis_.block(j) + at(row) * at(P);
        packed.block(Index{j} * P, 0, P, rows) = Eigen::Map<const MatrixXd>(block, P, rows);
      }
      write(row, product_at_b(packed.leftCols(rows), coefficients));
    }
  });
}

void BlockLanczos::write_vectors(int first, int count, double* X, std::int64_t stride) const {
  if (count == 0) return;
  const std::vector<int>& order = factor_.order();
  for_each_rows(coefficients(first, count), [&](int row, const MatrixXd& vectors) {
    for (Index k = 0; k < vectors.cols(); ++k) {
      double* const column = X + k * stride;
      for (Index i = 0; i < vectors.rows(); ++i) {
        column[order[at(row + static_cast<int>(i))]] = vectors(i, k);
      }
    }
  });
}

void BlockLanczos::lock(int first, int count) {
  const int P = options_.width;
  for (int done = 0; done < count; done += P) {
    const int some = std::min(P, count - done);
    double* const block = locked_.next();
    std::fill_n(block, locked_.numbers(), 0.0);
    for_each_rows(coefficients(first + done, some), [&](int row, const MatrixXd& vectors) {
      Eigen::Map<MatrixXd> rows(block + at(row) * at(P), P, vectors.rows());
      rows.topRows(some) = vectors.transpose();
    });
    locked_.append_next();
  }
}

}  // namespace timbre::detail
