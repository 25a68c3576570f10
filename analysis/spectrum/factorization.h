#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstdint>
#include <memory>

namespace timbre {

/// Which LDL^T of the shifted matrices `W - s M` the solver runs on. Results are the same.
enum class FactorizationBackend : std::uint8_t {
  automatic,   ///< the fastest: `supernodal`
  supernodal,  ///< of timbre: blocks of columns, pivots of 1 x 1 and 2 x 2
  cholmod,     ///< CHOLMOD's simplicial LDL^T; its supernodal one takes no indefinite matrix
  eigen,       ///< Eigen's SimplicialLDLT
};

/// Whether timbre was built with CHOLMOD.
[[nodiscard]] bool has_cholmod();

/// A factorised symmetric positive definite matrix, by timbre's own LDL^T.
class Factorization {
 public:
  /// @param matrix  n x n, of which the lower triangle is read
  /// @throws Error  not_converged if the matrix is not positive definite
  explicit Factorization(const Eigen::SparseMatrix<double>& matrix);
  ~Factorization();
  Factorization(Factorization&&) noexcept;
  Factorization& operator=(Factorization&&) noexcept;

  /// X := A^-1 X, for n x b numbers with any b: cheapest by columns in multiples of 32. May be
  /// called from several threads at once.
  void solve(Eigen::Ref<Eigen::MatrixXd> X) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace timbre
