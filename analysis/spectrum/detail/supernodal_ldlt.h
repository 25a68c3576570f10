#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"
#include "timbre/analysis/spectrum/detail/ordering.h"
#include "timbre/analysis/spectrum/detail/pencil.h"
#include "timbre/analysis/spectrum/detail/shifted_factor.h"
#include "timbre/analysis/spectrum/detail/symbolic.h"
#include "timbre/analysis/spectrum/detail/tile_kernels.h"

namespace timbre::detail {

struct LdltOptions {
  OrderingMethod ordering = OrderingMethod::automatic;
  int threads = 1;  ///< of factorisations and solves; 0: all cores. Results do not depend on it
  /// Solve for random right-hand sides after each factorisation and look at what comes back.
  /// About the time of 16 solves; without it `near_singular` only knows the pivots.
  bool check = true;
  InstructionSet instructions = best_instruction_set();
  /// Called now and then while factorising, on the thread that asked for it; may throw.
  std::function<void()> between = {};
};

/// L D L^T of K - s M for one pattern and any shifts: sparse, symmetric, definite or not.
///
/// Supernodal and multifrontal (Duff and Reid 1983); pivots of 1 x 1 and 2 x 2 chosen inside
/// panels (Bunch and Kaufman 1977), so that the structure is known beforehand and is that of
/// Cholesky. This suits shifts in the lower spectrum of finite elements, where only the last
/// separators are indefinite; for any other matrix the report tells whether it went well.
///
///     SupernodalLdlt ldlt(op.stiffness, op.mass, &mesh.vertices);
///     const LdltReport report = ldlt.factorize(shift);
///     ldlt.solve(X);
///
/// Solves may run on several threads at once, factorisations may not.
class SupernodalLdlt final : public ShiftedFactor {
 public:
  /// Orders and analyses. Lower triangles are read.
  ///
  /// @param K          n x n, symmetric
  /// @param M          n x n, symmetric; may be empty of entries
  /// @param positions  n x 3 for geometric ordering, or nullptr
  /// @throws Error  bad_request if sizes differ, or as compute_ordering says
  SupernodalLdlt(const Eigen::SparseMatrix<double>& K, const Eigen::SparseMatrix<double>& M,
                 const Points* positions = nullptr, const LdltOptions& options = {});
  ~SupernodalLdlt() override;
  SupernodalLdlt(SupernodalLdlt&&) noexcept;
  SupernodalLdlt& operator=(SupernodalLdlt&&) noexcept;

  LdltReport factorize(double shift) override;

  /// X := (K - s M)^-1 X for the last shift.
  ///
  /// @param X  n x b, any b
  /// @throws Error  bad_request before the first factorisation, or for another number of rows
  void solve(Eigen::Ref<Eigen::MatrixXd> X) const;

  void solve_in_factor_order(double* X, int width) const override;

  [[nodiscard]] const SymbolicFactor& symbolic() const;
  [[nodiscard]] const std::vector<int>& order() const override { return symbolic().order; }
  [[nodiscard]] const Pencil& pencil() const override;
  /// Bytes of the factor and the workspace of `factorize`; known before the first one.
  [[nodiscard]] std::int64_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace timbre::detail
