#include "timbre/analysis/spectrum/detail/spectrum_slicing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/threads.h"
#include "timbre/analysis/spectrum/detail/constants.h"

namespace timbre::detail {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kLeastGap = 1e-6;  // beside |lambda| + scale: copies are split by rounding only
constexpr Index kGuard = 8;         // pairs beyond those wanted, among which to find a gap
constexpr Index kLarge = 400000;    // unknowns, and above: the basis must be small

[[noreturn]] void fail(const std::string& cause) {
  throw Error(ErrorKind::not_converged, "", "spectrum", cause);
}

// Large bands need a large basis, small ones more factorisations.
int half_band(const SlicingOptions& options, Index n) {
  constexpr Index kSmall = 20000;
  if (options.half != 0) return options.half;
  if (n < kSmall) return 32;
  return n < kLarge ? 40 : 25;
}

int most_blocks(const SlicingOptions& options, Index n) {
  const int width = options.width;
  const int usual = 6 * (2 * half_band(options, n) + 8) / width + 8;
  return std::min(std::max(usual, 16), std::max(2, static_cast<int>(n) / width - 1));
}

std::unique_ptr<ShiftedFactor> ordered(const Eigen::SparseMatrix<double>& K,
                                       const Eigen::SparseMatrix<double>& M,
                                       const Points* positions, const SlicingOptions& options) {
  const PhaseClock::Scope phase(options.clock, &SpectrumPhases::ordering);
  std::function<void()> between;
  if (options.on_solve) between = [on_solve = options.on_solve] { on_solve(0); };
  return make_shifted_factor(K, M, positions, options.backend, options.threads, between);
}

}  // namespace

SpectrumSlicer::SpectrumSlicer(const Eigen::SparseMatrix<double>& K,
                               const Eigen::SparseMatrix<double>& M, const Points* positions,
                               const SlicingOptions& options)
    : mass_(M),
      options_(options),
      usual_half_(half_band(options, K.rows())),
      factor_(ordered(K, M, positions, options)),
      lanczos_(*factor_, {.width = options.width,
                          .most_blocks = most_blocks(options, K.rows()),
                          .threads = options.threads,
                          .on_solve = options.on_solve,
                          .clock = options.clock}),
      spacing_(4.0 * std::numbers::pi / M.sum()),
      pairs_(K.rows()) {
  state_.slope = spacing_;
  state_.lanczos.seed = options.seed;
  want(options.count);
  if (options.keep_all) pairs_.reserve(std::min(state_.wanted + kGuard, pairs_.rows()));
}

void SpectrumSlicer::want(Index count) {
  state_.wanted = std::max(state_.wanted, std::min(count, pairs_.rows()));
}

void SpectrumSlicer::advance() {
  const SingleThreadedBlas single;
  constexpr int kAttempts = 3;
  for (int attempt = 1;; ++attempt) {
    try {
      find_more();
      return;
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::not_converged || attempt == kAttempts) throw;
      lanczos_.unlock();
      state_.lanczos = lanczos_.memory();  // other starts
      step_back();
    }
  }
}

void SpectrumSlicer::forget_before(Index first) {
  pairs_.drop_before(std::min(first, state_.certain - kNeighbours));
}

LdltReport SpectrumSlicer::factorize(double shift) {
  const PhaseClock::Scope phase(options_.clock, &SpectrumPhases::factorization);
  return factor_->factorize(shift);
}

void SpectrumSlicer::find_more() {
  lanczos_.set_memory(state_.lanczos);
  if (state_.found < state_.wanted) {
    plan_band();
    search_around(place_shift());
    state_.lanczos = lanczos_.memory();
  }
  if (state_.found < state_.wanted) return;
  if (state_.found == pairs_.rows()) {
    state_.certain = state_.found;
    state_.bound = std::numeric_limits<double>::infinity();
  } else if (!is_cut_counted()) {
    confirm_cut();
    state_.lanczos = lanczos_.memory();
  }
}

// What remains is shared out evenly, so that no small band is left at the price of a full one.
void SpectrumSlicer::plan_band() {
  const auto left = static_cast<double>(state_.wanted - state_.found);
  const double bands = std::max(1.0, std::round(left / (2.0 * usual_half_)));
  half_ = (left + 3.0) / (2.0 * bands);
}

// Around a shift at which the factor and `count_` are.
void SpectrumSlicer::search_around(double shift) {
  const Index need = count_ - state_.found;
  const auto ahead =
      std::min({static_cast<Index>(half_), state_.wanted + 1 - count_, pairs_.rows() - count_});
  BandGoal goal{state_.cut, static_cast<int>(need), static_cast<int>(std::max<Index>(0, ahead)),
                scale(), tolerance()};
  BandPairs band = lanczos_.run(shift, goal);
  state_.slices.push_back({shift, count_, 0, 1});
  // A cluster may hide the gap behind it.
  constexpr int kTries = 3;
  const auto lacks_a_gap = [&] {
    return band.left == need && goal.right > 0 && end_before_gap(band) == need;
  };
  for (int i = 0; i < kTries && lacks_a_gap(); ++i) {
    goal.right = 2 * std::max(band.right, static_cast<int>(kGuard));
    band = lanczos_.go_on(shift, goal);
  }
  if (band.left == need) {
    accept(shift, band);
  } else {
    repair(shift, goal, std::move(band));
  }
  state_.certain = count_;
  state_.bound = shift;
}

// The last count. If it says that copies are missing below the cut, they are looked for there.
void SpectrumSlicer::confirm_cut() {
  if (options_.certify) {
    count_ = count_at_cut();
    if (count_ != state_.found) {
      const double at = state_.cut;
      step_back();
      search_around(at);
      return;
    }
  }
  state_.certain = state_.found;
  state_.bound = state_.cut;
}

// Factorises at the cut, or beside it in the same gap where the count there is in doubt.
Index SpectrumSlicer::count_at_cut() {
  constexpr std::array kPlaces = {0.0, 0.15, -0.15, 0.3, -0.3};
  for (const double place : kPlaces) {
    const double bound = state_.cut + place * state_.gap;
    const LdltReport report = factorize(bound);
    if (report.near_singular) continue;
    state_.cut = bound;
    return static_cast<Index>(report.negative);
  }
  fail("the count of eigenvalues is in doubt everywhere in a gap between them");
}

// Factorises where about `half_` pairs more are expected below, and counts them. Where a cluster
// of more than a band's pairs is in the way, close behind it.
double SpectrumSlicer::place_shift() {
  constexpr int kTries = 40;
  constexpr double kNarrow = 1e-3;  // between the ends of a cluster, beside its eigenvalue
  const auto found = static_cast<double>(state_.found);
  const auto wanted = static_cast<double>(state_.wanted);
  const double target = std::min(found + half_, std::max(found + 1.0, wanted));
  double low = std::max(0.0, state_.cut);                 // none of those wanted is below
  double high = std::numeric_limits<double>::infinity();  // too many are below
  double shift = low + (target - found) * state_.slope;
  for (int i = 0; i < kTries; ++i) {
    const LdltReport report = factorize(shift);
    if (report.near_singular) {
      shift += 1e-3 * state_.slope * (1.0 + i);
      continue;
    }
    const auto more = static_cast<double>(report.negative - state_.found);
    if (more < 0.0) fail("fewer eigenvalues below a shift than were found");
    const bool is_too_far = more > 1.75 * half_ + 10.0;
    const bool is_narrow = is_too_far && shift - low <= kNarrow * shift;
    if (is_narrow || (!is_too_far && (more > 0.0 || std::isinf(high)))) {
      count_ = static_cast<Index>(report.negative);
      return shift;
    }
    if (is_too_far) {
      state_.slope *= half_ / more;
      high = shift;
      shift = low + (shift - low) * std::max(half_ / more, 0.25);
    } else {
      low = shift;
      shift = 0.5 * (low + high);
    }
  }
  fail("no shift with a share of the spectrum below it was found");
}

// How many pairs lie below the widest gap, in the last quarter of those above the shift or
// after the last one wanted, or else below the next gap behind; those below the shift if there is
// no clear gap.
Index SpectrumSlicer::end_before_gap(const BandPairs& band) const {
  const auto total = static_cast<Index>(band.values.size());
  if (state_.found + total == pairs_.rows()) return total;  // there is nothing behind
  const Index left = band.left;
  const Index end = std::min(total, std::max(left, state_.wanted + kGuard - state_.found));
  Index first = std::max<Index>(left + (end - left) * 3 / 4, left + 1);
  if (state_.found + end > state_.wanted) first = std::max(first, state_.wanted - state_.found);
  Index best = left;
  double widest = 0.0;
  for (Index i = std::max<Index>(first, 1); i < (best == left ? total : end); ++i) {
    const double above = band.values[static_cast<std::size_t>(i)];
    const double gap = above - band.values[static_cast<std::size_t>(i - 1)];
    if (gap <= std::max(widest, kLeastGap * (std::abs(above) + scale()))) continue;
    widest = gap;
    best = i;
  }
  return best;
}

// Everything up to a cut in a gap, or up to the shift.
void SpectrumSlicer::accept(double shift, const BandPairs& band) {
  const Index best = end_before_gap(band);
  double cut = shift;
  if (best > band.left && best < std::ssize(band.values)) {
    const double below = band.values[static_cast<std::size_t>(best - 1)];
    state_.gap = band.values[static_cast<std::size_t>(best)] - below;
    cut = below + 0.5 * state_.gap;
  }
  const PhaseClock::Scope phase(options_.clock, &SpectrumPhases::vectors);
  pairs_.append(best);
  lanczos_.write_vectors(0, static_cast<int>(best), pairs_.column(state_.found), pairs_.rows());
  for (Index i = 0; i < best; ++i) {
    pairs_.value(state_.found + i) = band.values[static_cast<std::size_t>(i)];
  }
  polish(best);
  advance_to(cut, best);
}

// Pairs of two bands are orthogonal only to their errors over their distance: those next to each
// other are made so.
void SpectrumSlicer::polish(Index fresh) {
  auto all = pairs_.vectors(state_.found, fresh);
  const Index old = std::min(kNeighbours, state_.found - pairs_.first());
  const Index count = std::min(kNeighbours, fresh);
  if (old > 0 && count > 0) {
    const auto before = pairs_.vectors(state_.found - old, old);
    auto after = all.leftCols(count);
    const MatrixXd mass_before = mass_ * before;
    after -= before * (mass_before.transpose() * after).eval();
    for (Index i = 0; i < count; ++i) {
      after.col(i) /= std::sqrt(after.col(i).dot(mass_ * after.col(i)));
    }
  }
  for (Index i = 0; i < fresh; ++i) {
    double& value = pairs_.value(state_.found + i);
    value = std::max(value, 0.0);
  }
  if (options_.has_constants) put_constants(mass_, pairs_, state_.found, fresh);
}

// Some copies of multiple eigenvalues are missing: those found are kept out of further runs,
// until the count is met. Then all up to the shift is taken.
void SpectrumSlicer::repair(double shift, const BandGoal& goal, BandPairs band) {
  step_back_if_cut_is_wrong(shift);
  const Index need = count_ - state_.found;
  VectorXd values(need);
  MatrixXd vectors(pairs_.rows(), need);
  BandGoal rest = goal;
  rest.cut = state_.cut;
  Index have = 0;
  if (rest.cut != goal.cut) {
    band = lanczos_.run(shift, {state_.cut, static_cast<int>(need), 0, goal.scale, goal.tolerance});
  }
  for (;;) {
    if (band.left == 0 || have + band.left > need) fail("the inertia count cannot be met");
    lanczos_.write_vectors(0, band.left, vectors.col(have).data(), vectors.rows());
    for (Index i = 0; i < band.left; ++i) {
      values[have + i] = band.values[static_cast<std::size_t>(i)];
    }
    have += band.left;
    if (have == need) break;
    lanczos_.lock(0, static_cast<int>(band.values.size()));
    rest.left = static_cast<int>(need - have);
    rest.right = 0;
    band = lanczos_.run(shift, rest);
    ++state_.slices.back().runs;
  }
  lanczos_.unlock();
  std::vector<Index> order(static_cast<std::size_t>(need));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return values[a] < values[b]; });
  pairs_.append(need);
  for (Index i = 0; i < need; ++i) {
    pairs_.value(state_.found + i) = values[order[static_cast<std::size_t>(i)]];
    pairs_.vectors(state_.found + i, 1) = vectors.col(order[static_cast<std::size_t>(i)]);
  }
  polish(need);
  advance_to(shift, need);
}

// The copies may be missing below the cut: it was chosen by what a run had seen. Everything up
// to the last shift is certain.
void SpectrumSlicer::step_back_if_cut_is_wrong(double shift) {
  if (is_cut_counted()) return;
  if (count_at_cut() != state_.found) step_back();
  if (factorize(shift).negative != count_) fail("two counts at one shift differ");
}

// To the last shift: everything below it is certain.
void SpectrumSlicer::step_back() {
  state_.found = state_.certain;
  state_.cut = state_.bound;
  pairs_.truncate(state_.found);
}

// About the largest eigenvalue wanted.
double SpectrumSlicer::scale() const {
  return std::max(state_.slope, spacing_) * static_cast<double>(state_.wanted);
}

// Pairs of different bands are orthogonal to their errors over their distance, and the more are
// wanted, the closer they lie beside the largest, by which errors are measured.
double SpectrumSlicer::tolerance() const {
  constexpr double kFew = 100.0;
  return options_.tolerance * std::min(1.0, kFew / static_cast<double>(state_.wanted));
}

void SpectrumSlicer::advance_to(double cut, Index accepted) {
  const double from = std::max(0.0, state_.cut);
  state_.found += accepted;
  state_.cut = cut;
  state_.slices.back().accepted = static_cast<int>(accepted);
  if (accepted == 0) state_.slope *= 2.0;  // a gap is here, and perhaps a cluster behind it
  if (state_.found <= 20 || accepted == 0) return;
  const double last = pairs_.value(state_.found - 1);
  state_.slope = (last - from) / static_cast<double>(accepted);
  if (!(state_.slope > 0.0)) state_.slope = spacing_;
}

}  // namespace timbre::detail
