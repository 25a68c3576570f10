#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"
#include "timbre/analysis/spectrum/detail/pencil.h"
#include "timbre/analysis/spectrum/factorization.h"

namespace timbre::detail {

/// What is known of one factorisation of A = K - s M.
struct LdltReport {
  double shift = 0.0;
  std::int64_t negative = 0;  ///< negative eigenvalues of A, by Sylvester's law of inertia
  /// The shift is an eigenvalue to rounding, or the pivots that were chosen are not enough:
  /// `negative` may be wrong and solves inexact. Move the shift.
  bool near_singular = false;
  std::int64_t two_by_two = 0;  ///< 2 x 2 pivots
  std::int64_t replaced = 0;    ///< pivots that were 0 to rounding
  double smallest_pivot = 1.0;  ///< beside the largest entry of its row in A
  /// Largest |A x - b| / (|A| |x| + |b|) over the checked solves, in the norm in which every row
  /// of A is scaled to 1; near 1e-16 for a stable factorisation. 0 without a check.
  double backward_error = 0.0;
  /// Largest |A x - b| / |b| after a step of inverse iteration, in that norm: the error of the
  /// factor as a share of the smallest eigenvalue. The count is right while this is far below 1.
  double residual = 0.0;
};

/// L D L^T of K - s M for two symmetric matrices on one pattern and any shifts: what a shift-invert
/// method asks of a factorisation, whoever computes it.
class ShiftedFactor {
 public:
  virtual ~ShiftedFactor() = default;
  ShiftedFactor(const ShiftedFactor&) = delete;
  ShiftedFactor& operator=(const ShiftedFactor&) = delete;

  /// Factorises K - shift M, in place of what was factorised before.
  virtual LdltReport factorize(double shift) = 0;

  /// X := (K - s M)^-1 X for the last shift; row i of X belongs to unknown order()[i].
  ///
  /// @param X      n x width, row-major, best aligned to 64 bytes
  /// @param width  8, 16 or 32
  virtual void solve_in_factor_order(double* X, int width) const = 0;

  [[nodiscard]] virtual const std::vector<int>& order() const = 0;
  [[nodiscard]] virtual const Pencil& pencil() const = 0;  ///< K and M in factor order

 protected:
  ShiftedFactor() = default;
  ShiftedFactor(ShiftedFactor&&) = default;
  ShiftedFactor& operator=(ShiftedFactor&&) = default;
};

/// Whether the residual of a check leaves the count in doubt; a factor of 100 below 1, since its
/// random vectors see only a part of the error.
[[nodiscard]] inline bool is_doubtful(double residual) { return !(residual < 1e-2); }

/// Orders and analyses K - s M.
///
/// @param K          n x n, symmetric
/// @param M          n x n, symmetric
/// @param positions  n x 3 for an ordering that is found fast, or nullptr for one with less fill;
///                   other backends than `supernodal` have their own
/// @param threads    of `supernodal`; 0: all cores. Results do not depend on it
/// @param between    called now and then while `supernodal` factorises; what it throws leaves
///                   nothing factorised
/// @throws Error  bad_request for a backend that this build lacks
[[nodiscard]] std::unique_ptr<ShiftedFactor> make_shifted_factor(
    const Eigen::SparseMatrix<double>& K, const Eigen::SparseMatrix<double>& M,
    const Points* positions, FactorizationBackend backend, int threads = 1,
    std::function<void()> between = {});

}  // namespace timbre::detail
