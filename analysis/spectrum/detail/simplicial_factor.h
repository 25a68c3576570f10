#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "timbre/analysis/spectrum/detail/shifted_factor.h"

namespace timbre::detail {

/// A sparse LDL^T without supernodes and with pivots of 1 x 1 only, by a library.
class SimplicialLdlt {
 public:
  using Matrix = Eigen::SparseMatrix<double>;  // its lower triangle is there

  virtual ~SimplicialLdlt() = default;
  /// @return  the pivots; fewer than n if one was 0
  [[nodiscard]] virtual std::vector<double> factorize(const Matrix& A) = 0;
  /// X := A^-1 X, for n x b numbers, column-major.
  virtual void solve(Eigen::MatrixXd& X) const = 0;
};

[[nodiscard]] std::unique_ptr<SimplicialLdlt> make_eigen_ldlt();
/// Only in a build with CHOLMOD.
[[nodiscard]] std::unique_ptr<SimplicialLdlt> make_cholmod_ldlt();

/// Makes a factor for shifts of such an LDL^T. Unknowns keep their order outside.
[[nodiscard]] std::unique_ptr<ShiftedFactor> make_simplicial_factor(
    const Eigen::SparseMatrix<double>& K, const Eigen::SparseMatrix<double>& M,
    std::unique_ptr<SimplicialLdlt> ldlt);

}  // namespace timbre::detail
