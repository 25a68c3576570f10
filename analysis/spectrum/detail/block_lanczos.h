#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "timbre/analysis/spectrum/detail/banded_eigenproblem.h"
#include "timbre/analysis/spectrum/detail/block_basis.h"
#include "timbre/analysis/spectrum/detail/phase_clock.h"
#include "timbre/analysis/spectrum/detail/shifted_factor.h"

namespace timbre::detail {

struct LanczosOptions {
  int width = 8;  ///< vectors in a block, 8 or 16: more is faster to solve, but a larger basis
  int most_blocks = 64;                    ///< of the basis
  int threads = 1;                         ///< 0: all cores
  std::function<void(int)> on_solve = {};  ///< after so many solves; may throw
  PhaseClock* clock = nullptr;             ///< must outlive the method
};

/// What one run leaves to the next.
struct LanczosMemory {
  std::uint64_t seed = 1;    ///< of the next start
  double basis_share = 1.0;  ///< of the usual size of a basis, learnt from run to run
};

/// What is wanted of a run.
struct BandGoal {
  double cut = 0.0;         ///< pairs at or below are known
  int left = 0;             ///< how many lie between the cut and the shift
  int right = 0;            ///< how many above the shift are wanted, at least
  double scale = 0.0;       ///< of eigenvalues: errors are measured beside |lambda| + scale
  double tolerance = 1e-9;  ///< of a pair, in that measure
};

/// Converged pairs around a shift: an interval without a gap, as far as a Krylov space can see.
struct BandPairs {
  std::vector<double> values;  ///< ascending
  int left = 0;                ///< below the shift
  int right = 0;
  bool sees_the_cut = false;  ///< a pair at or below the cut has converged, or none are left to see
};

/// Shift-invert Lanczos with blocks in the M inner product (Grimes, Lewis and Simon 1994), one
/// shift at a time. Vectors are in the order of the factor. Each step is orthogonalised against
/// two of three blocks' predecessors in full: one skipped step at a time costs no digit.
class BlockLanczos {
 public:
  /// @param factor  factorised at the shift of the next run; must outlive this
  BlockLanczos(const ShiftedFactor& factor, LanczosOptions options);
  BlockLanczos(const BlockLanczos&) = delete;  // its bases refer to its mass
  BlockLanczos& operator=(const BlockLanczos&) = delete;

  /// Runs until the goal is reached, or `most_blocks`.
  /// @param shift  that of the factor
  [[nodiscard]] BandPairs run(double shift, const BandGoal& goal);

  /// Goes on with the last run for a higher goal.
  [[nodiscard]] BandPairs go_on(double shift, const BandGoal& goal);

  /// Keeps pairs [first, first + count) of the last run out of the next ones, so that these find
  /// further copies of multiple eigenvalues.
  void lock(int first, int count);
  void unlock() { locked_.clear(); }

  [[nodiscard]] const LanczosMemory& memory() const { return memory_; }
  void set_memory(const LanczosMemory& memory) { memory_ = memory; }

  /// Vectors of pairs [first, first + count) of the last run, M-orthonormal, to columns of X in
  /// the caller's order.
  void write_vectors(int first, int count, double* X, std::int64_t stride) const;

 private:
  [[nodiscard]] BandPairs search(double shift, const BandGoal& goal, int next_test, int& tests);
  void write_random(double* U);
  void start();
  void write_random_columns(const std::vector<int>& columns, double* U);
  void step();
  void solve(double* X);
  [[nodiscard]] bool try_goal(double shift, const BandGoal& goal, BandPairs& found, int& missing);
  [[nodiscard]] Eigen::MatrixXd coefficients(int first, int count) const;
  template <typename Write>
  void for_each_rows(const Eigen::MatrixXd& coefficients, Write write) const;

  const ShiftedFactor& factor_;
  LanczosOptions options_;
  BlockMass mass_;
  BlockBasis basis_;
  BlockBasis locked_;
  AlignedArray Z_;  // M times the last block
  BandedMatrix projected_;
  Square last_factor_;  // R of the last block
  BandedEigenpairs small_;
  std::vector<int> chosen_;  // of small_, in the order of the pairs
  double largest_ = 0.0;     // entry of a diagonal block
  bool full_passes_only_ = false;
  double drift_ = 0.0;  // the largest loss of orthogonality that a full pass has met in this run
  LanczosMemory memory_;
};

}  // namespace timbre::detail
