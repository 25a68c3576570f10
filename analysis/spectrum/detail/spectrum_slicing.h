#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"
#include "timbre/analysis/spectrum/detail/block_lanczos.h"
#include "timbre/analysis/spectrum/detail/pair_window.h"
#include "timbre/analysis/spectrum/detail/phase_clock.h"
#include "timbre/analysis/spectrum/detail/shifted_factor.h"

namespace timbre::detail {

struct SlicingOptions {
  Eigen::Index count = 100;  ///< pairs wanted, from the lowest; `want` can raise it
  /// Of a pair, beside |lambda| + the largest wanted; less where more than 100 are wanted.
  double tolerance = 1e-9;
  int half = 0;         ///< pairs on each side of a shift, about; 0: chosen by size
  int width = 8;        ///< of blocks, 8 or 16: wider ones solve faster, with a larger basis
  bool certify = true;  ///< count at the end of the list, too
  /// The kernel of K is the constants: the first pair becomes exactly that.
  bool has_constants = false;
  FactorizationBackend backend = FactorizationBackend::automatic;
  /// Take the memory for all vectors at the beginning: where none will be forgotten.
  bool keep_all = false;
  std::uint64_t seed = 1;  ///< of start vectors
  int threads = 1;         ///< 0: all cores. Results do not depend on it
  /// After so many solves with a factor, 0 while it is made; may throw.
  std::function<void(int)> on_solve = {};
  PhaseClock* clock = nullptr;  ///< must outlive the slicer
};

/// One shift and what was found around it.
struct SliceReport {
  double shift = 0.0;
  std::int64_t below = 0;  ///< eigenvalues below the shift, by inertia
  int accepted = 0;        ///< pairs taken from this band
  int runs = 0;            ///< of the iteration; more than 1 after a repair
};

/// All that the next band depends on, but the pairs of the window.
struct SlicingState {
  static constexpr double kNowhere = -std::numeric_limits<double>::infinity();

  Eigen::Index wanted = 0;
  Eigen::Index found = 0;    ///< pairs up to `cut`
  Eigen::Index certain = 0;  ///< of these: exactly as many lie below `bound`, by inertia
  double bound = kNowhere;   ///< infinite once every pair of the matrices is known
  double cut = kNowhere;     ///< where the next band begins
  double gap = 0.0;          ///< between eigenvalues, in whose middle the cut was put
  double slope = 0.0;        ///< spacing of eigenvalues, as found lately
  LanczosMemory lanczos;
  std::vector<SliceReport> slices;

  /// To or from a StateWriter or StateReader.
  template <typename File>
  void exchange(File& file) {
    for (Eigen::Index* number : {&wanted, &found, &certain}) exchange_value(file, *number);
    for (double* number : {&bound, &cut, &gap, &slope}) exchange_value(file, *number);
    exchange_value(file, lanczos);
    exchange_vector(file, slices);
  }
};

/// The lowest eigenpairs of K x = lambda M x, band by band: a shift inside the spectrum, its
/// inertia count, block Lanczos around it, and a cut in a gap where the next band begins
/// (spectrum slicing: Parlett 1980, section 3.3; Grimes, Lewis and Simon 1994). All pairs between
/// two shifts are there when their number is what the counts say; where copies of a multiple
/// eigenvalue are missing, they are looked for beside those known. Pairs above the last shift are
/// certain only after the next.
class SpectrumSlicer {
 public:
  /// Pairs on each side of a cut that are made orthogonal to each other.
  static constexpr Eigen::Index kNeighbours = 20;

  /// Orders and analyses; computes no pair.
  ///
  /// @param K          n x n, symmetric, positive semi-definite; n above
  ///                   200; the smaller, the more often counts cannot be met
  /// @param M          n x n, symmetric, positive definite; about sum(M) / (4 pi) eigenvalues are
  ///                   expected in a unit interval (Weyl). Must outlive this
  /// @param positions  n x 3 for a geometric ordering, or nullptr
  SpectrumSlicer(const Eigen::SparseMatrix<double>& K, const Eigen::SparseMatrix<double>& M,
                 const Points* positions, const SlicingOptions& options);

  /// Raises the number of pairs wanted; capped at n.
  void want(Eigen::Index count);
  [[nodiscard]] bool is_done() const { return state_.certain >= state_.wanted; }

  /// Finds some more pairs, or proves some to be all there are, and so raises `state().certain`.
  ///
  /// @throws Error  not_converged if the counts cannot be met, with several starts
  void advance();

  [[nodiscard]] const SlicingState& state() const { return state_; }
  [[nodiscard]] const PairWindow& pairs() const { return pairs_; }  ///< up to `found`
  [[nodiscard]] const ShiftedFactor& factor() const { return *factor_; }

  /// Pairs before number `first` are not asked for any more. Some of them are kept for a while.
  void forget_before(Eigen::Index first);
  /// Gives the first vectors away, where none was forgotten; the end of this slicer.
  [[nodiscard]] Eigen::MatrixXd release_vectors(Eigen::Index count) {
    return pairs_.release(count);
  }

  /// To or from a StateWriter or StateReader; a slicer of the same matrices and options goes on
  /// where the other was.
  template <typename File>
  void exchange(File& file) {
    state_.exchange(file);
    pairs_.exchange(file);
  }

 private:
  LdltReport factorize(double shift);
  void find_more();
  void plan_band();
  void search_around(double shift);
  void confirm_cut();
  Eigen::Index count_at_cut();
  double place_shift();
  [[nodiscard]] Eigen::Index end_before_gap(const BandPairs& band) const;
  void accept(double shift, const BandPairs& band);
  void repair(double shift, const BandGoal& goal, BandPairs band);
  void step_back_if_cut_is_wrong(double shift);
  void step_back();
  void polish(Eigen::Index fresh);
  void advance_to(double cut, Eigen::Index accepted);
  [[nodiscard]] bool is_cut_counted() const { return state_.found == state_.certain; }
  [[nodiscard]] double scale() const;
  [[nodiscard]] double tolerance() const;

  const Eigen::SparseMatrix<double>& mass_;
  SlicingOptions options_;
  int usual_half_;
  std::unique_ptr<ShiftedFactor> factor_;
  BlockLanczos lanczos_;
  double spacing_;  // of eigenvalues, by Weyl's law
  PairWindow pairs_;
  SlicingState state_;
  double half_ = 0.0;       // pairs on each side of the shift in this band
  Eigen::Index count_ = 0;  // eigenvalues below the present shift
};

}  // namespace timbre::detail
