#include "timbre/analysis/spectrum/detail/spectrum_slicing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/threads.h"
#include "timbre/analysis/spectrum/detail/block_lanczos.h"

namespace timbre::detail {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kLeastGap = 1e-6;  // beside |lambda| + scale: copies are split by rounding only
constexpr Index kGuard = 8;         // pairs beyond those wanted, among which to find a gap

[[noreturn]] void fail(const std::string& cause) {
  throw Error(ErrorKind::not_converged, "", "spectrum", cause);
}

int block_width(const SlicingOptions& options) {
  if (options.width != 0) return options.width;
  return options.count <= 150 ? 8 : 16;
}

int most_blocks(const SlicingOptions& options, Index n) {
  const auto width = block_width(options);
  const int usual = 6 * (2 * options.half + 8) / width + 8;
  return std::clamp(usual, 16, std::max(2, static_cast<int>(n) / width - 1));
}

class Slicer {
 public:
  Slicer(const Eigen::SparseMatrix<double>& K, const Eigen::SparseMatrix<double>& M,
         const Points* positions, const SlicingOptions& options)
      : mass_(M),
        wanted_(options.count),
        ldlt_(K, M, positions, {}),
        lanczos_(ldlt_, {.width = block_width(options),
                         .tolerance = options.tolerance,
                         .seed = options.seed,
                         .most_blocks = most_blocks(options, K.rows()),
                         .on_solve = options.on_solve}),
        spacing_(4.0 * std::numbers::pi / M.sum()),
        slope_(spacing_) {
    const auto bands =
        std::max<Index>(1, std::llround(static_cast<double>(wanted_) / (2.0 * options.half)));
    half_ = static_cast<double>(wanted_ + 3) / (2.0 * static_cast<double>(bands));
    pairs_.values.resize(wanted_ + kGuard);
    pairs_.vectors.resize(K.rows(), wanted_ + kGuard);
  }

  SlicedPairs run() {
    while (done_ < wanted_) search_around(place_shift());
    if (!is_cut_counted_) confirm_cut();
    pairs_.bound = cut_;
    pairs_.values.conservativeResize(done_);
    pairs_.vectors.conservativeResize(Eigen::NoChange, done_);
    return std::move(pairs_);
  }

 private:
  // Around a shift at which the factor and `count_` are.
  void search_around(double shift) {
    const Index need = count_ - done_;
    const double ahead = std::min(half_, static_cast<double>(wanted_ + 1 - count_));
    BandGoal goal{cut_, static_cast<int>(need), static_cast<int>(std::max(0.0, ahead)), scale()};
    BandPairs found = lanczos_.run(shift, goal);
    pairs_.slices.push_back({shift, count_, 0, 1});
    // A cluster may hide the gap behind it.
    constexpr int kTries = 3;
    const auto lacks_a_gap = [&] {
      return found.left == need && goal.right > 0 && end_before_gap(found) == need;
    };
    for (int i = 0; i < kTries && lacks_a_gap(); ++i) {
      goal.right = 2 * std::max(found.right, static_cast<int>(kGuard));
      found = lanczos_.go_on(shift, goal);
    }
    if (found.left == need) {
      accept(shift, found);
    } else {
      repair(shift, goal, found);
    }
    counted_ = count_;
    counted_shift_ = shift;
  }

  // The last count. If it says that copies are missing below the cut, they are looked for there.
  void confirm_cut() {
    count_ = count_at_cut();
    if (count_ == done_) return;
    const double bound = cut_;
    step_back();
    search_around(bound);
    if (done_ < wanted_) fail("the inertia counts of two shifts disagree");
  }

  // Factorises at the cut, or beside it in the same gap where the count there is in doubt.
  Index count_at_cut() {
    constexpr std::array kPlaces = {0.0, 0.15, -0.15, 0.3, -0.3};
    for (const double place : kPlaces) {
      const double bound = cut_ + place * gap_;
      const LdltReport report = ldlt_.factorize(bound);
      if (report.near_singular) continue;
      cut_ = bound;
      return static_cast<Index>(report.negative);
    }
    fail("the count of eigenvalues is in doubt everywhere in a gap between them");
  }

  // Factorises where about `half_` pairs more are expected below, and counts them.
  double place_shift() {
    const double k = static_cast<double>(wanted_);
    const double target =
        std::min(static_cast<double>(done_) + half_, std::max(static_cast<double>(done_) + 1.0, k));
    const double from = std::max(anchor_, cut_);
    double shift = anchor_ + (target - static_cast<double>(done_)) * slope_;
    constexpr int kTries = 12;
    for (int i = 0; i < kTries; ++i) {
      const LdltReport report = ldlt_.factorize(shift);
      if (report.near_singular) {
        shift += 1e-3 * slope_ * (1.0 + i);
        continue;
      }
      const auto more = static_cast<double>(report.negative - done_);
      if (more < 0.0) fail("fewer eigenvalues below a shift than were found");
      if (more <= 3.0 * half_ + 10.0) {
        count_ = static_cast<Index>(report.negative);
        return shift;
      }
      slope_ *= half_ / more;
      shift = from + (shift - from) * half_ / more;
    }
    fail("no shift with a share of the spectrum below it was found");
  }

  // How many pairs lie below the widest gap, in the last quarter of those above the shift or
  // after the last one wanted; those below the shift if there is no clear gap.
  [[nodiscard]] Index end_before_gap(const BandPairs& found) const {
    const auto total = static_cast<Index>(found.values.size());
    const Index left = found.left;
    const Index end = std::min(total, std::max(left, wanted_ + kGuard - done_));
    Index first = std::max<Index>(left + (end - left) * 3 / 4, left + 1);
    if (done_ + end > wanted_) first = std::max(first, wanted_ - done_);
    Index best = left;
    double widest = 0.0;
    for (Index i = std::max<Index>(first, 1); i < end; ++i) {
      const double above = found.values[static_cast<std::size_t>(i)];
      const double gap = above - found.values[static_cast<std::size_t>(i - 1)];
      if (gap <= std::max(widest, kLeastGap * (std::abs(above) + scale()))) continue;
      widest = gap;
      best = i;
    }
    return best;
  }

  // Everything up to a cut in a gap, or up to the shift.
  void accept(double shift, const BandPairs& found) {
    const Index best = end_before_gap(found);
    is_cut_counted_ = best == found.left;
    cut_ = shift;
    if (!is_cut_counted_) {
      const double below = found.values[static_cast<std::size_t>(best - 1)];
      gap_ = found.values[static_cast<std::size_t>(best)] - below;
      cut_ = below + 0.5 * gap_;
    }
    make_room(done_ + best);
    lanczos_.write_vectors(0, static_cast<int>(best), column(done_), pairs_.vectors.rows());
    clean_seam(best);
    for (Index i = 0; i < best; ++i) {
      pairs_.values[done_ + i] = found.values[static_cast<std::size_t>(i)];
    }
    advance(best);
  }

  // Pairs of two bands are orthogonal only to their errors over their distance: those next to
  // each other are made so.
  void clean_seam(Index fresh) {
    constexpr Index kNeighbours = 20;
    const Index old = std::min(kNeighbours, done_);
    const Index count = std::min(kNeighbours, fresh);
    if (old == 0 || count == 0) return;
    auto before = pairs_.vectors.middleCols(done_ - old, old);
    auto after = pairs_.vectors.middleCols(done_, count);
    const MatrixXd mass_before = mass_ * before;
    after -= before * (mass_before.transpose() * after).eval();
    for (Index i = 0; i < count; ++i) {
      after.col(i) /= std::sqrt(after.col(i).dot(mass_ * after.col(i)));
    }
  }

  // Some copies of multiple eigenvalues are missing: those found are kept out of further runs,
  // until the count is met. Then all up to the shift is taken.
  void repair(double shift, const BandGoal& goal, BandPairs found) {
    step_back_if_cut_is_wrong(shift);
    const Index need = count_ - done_;
    VectorXd values(need);
    MatrixXd vectors(pairs_.vectors.rows(), need);
    BandGoal rest = goal;
    rest.cut = cut_;
    Index have = 0;
    if (rest.cut != goal.cut)
      found = lanczos_.run(shift, {cut_, static_cast<int>(need), 0, goal.scale});
    for (;;) {
      if (found.left == 0 || have + found.left > need) fail("the inertia count cannot be met");
      lanczos_.write_vectors(0, found.left, vectors.col(have).data(), vectors.rows());
      for (Index i = 0; i < found.left; ++i) {
        values[have + i] = found.values[static_cast<std::size_t>(i)];
      }
      have += found.left;
      if (have == need) break;
      lanczos_.lock(0, static_cast<int>(found.values.size()));
      rest.left = static_cast<int>(need - have);
      rest.right = 0;
      found = lanczos_.run(shift, rest);
      ++pairs_.slices.back().runs;
    }
    lanczos_.unlock();
    std::vector<Index> order(static_cast<std::size_t>(need));
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return values[a] < values[b]; });
    make_room(done_ + need);
    for (Index i = 0; i < need; ++i) {
      pairs_.values[done_ + i] = values[order[static_cast<std::size_t>(i)]];
      pairs_.vectors.col(done_ + i) = vectors.col(order[static_cast<std::size_t>(i)]);
    }
    cut_ = shift;
    is_cut_counted_ = true;
    advance(need);
  }

  // The copies may be missing below the cut: it was chosen by what a run had seen. Everything up
  // to the last shift is certain.
  void step_back_if_cut_is_wrong(double shift) {
    if (is_cut_counted_) return;
    if (count_at_cut() != done_) step_back();
    if (ldlt_.factorize(shift).negative != count_) fail("two counts at one shift differ");
  }

  // To the last shift: everything below it is certain.
  void step_back() {
    done_ = counted_;
    cut_ = counted_shift_;
    is_cut_counted_ = true;
  }

  // About the largest eigenvalue wanted.
  [[nodiscard]] double scale() const {
    return std::max(slope_, spacing_) * static_cast<double>(wanted_);
  }

  void make_room(Index columns) {
    if (columns <= pairs_.values.size()) return;
    pairs_.values.conservativeResize(columns + kGuard);
    pairs_.vectors.conservativeResize(Eigen::NoChange, columns + kGuard);
  }

  [[nodiscard]] double* column(Index i) { return pairs_.vectors.col(i).data(); }

  void advance(Index accepted) {
    const Index before = done_;
    done_ += accepted;
    pairs_.slices.back().accepted = static_cast<int>(accepted);
    const double last = done_ > 0 ? pairs_.values[done_ - 1] : 0.0;
    if (done_ > 20 && accepted > 0) {
      slope_ = before > 0 ? (last - anchor_) / static_cast<double>(accepted)
                          : last / static_cast<double>(done_);
      if (!(slope_ > 0.0)) slope_ = spacing_;
    }
    anchor_ = cut_;
  }

  const Eigen::SparseMatrix<double>& mass_;
  Index wanted_;
  SupernodalLdlt ldlt_;
  BlockLanczos lanczos_;
  double spacing_;  // of eigenvalues, by Weyl's law
  double slope_;    // the same, as found lately
  double half_ = 0.0;
  SlicedPairs pairs_;
  Index done_ = 0;       // pairs accepted
  double anchor_ = 0.0;  // where they end
  double cut_ = -std::numeric_limits<double>::infinity();
  double gap_ = 0.0;  // between eigenvalues, in whose middle the cut was put
  bool is_cut_counted_ = true;
  Index count_ = 0;    // eigenvalues below the present shift
  Index counted_ = 0;  // below the last one, all of which are known
  double counted_shift_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

SlicedPairs lowest_pairs(const Eigen::SparseMatrix<double>& K, const Eigen::SparseMatrix<double>& M,
                         const Points* positions, const SlicingOptions& options) {
  const SingleThreadedBlas single;
  return Slicer(K, M, positions, options).run();
}

}  // namespace timbre::detail
