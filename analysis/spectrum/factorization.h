#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <memory>

namespace timbre {

/// Which library factorises `W - s M`.
enum class FactorizationBackend : std::uint8_t {
  automatic,  ///< CHOLMOD where timbre was built with it, Eigen otherwise
  cholmod,    ///< SuiteSparse
  eigen,      ///< SimplicialLDLT of Eigen; always there
};

/// Whether timbre was built with CHOLMOD.
[[nodiscard]] bool has_cholmod();

/// A factorised symmetric positive definite matrix.
class Factorization {
 public:
  /// @throws Error  not_converged if the matrix is not positive definite;
  ///                bad_request for a backend that this build lacks
  explicit Factorization(const Eigen::SparseMatrix<double>& matrix,
                         FactorizationBackend backend = FactorizationBackend::automatic);
  ~Factorization();
  Factorization(Factorization&&) noexcept;
  Factorization& operator=(Factorization&&) noexcept;

  /// x = A^-1 b; both of the matrix's size. One call at a time.
  void solve(const double* b, double* x);

  struct Impl;  ///< one per library, in the .cpp

 private:
  std::unique_ptr<Impl> impl_;
};

/// Number of negative eigenvalues of a symmetric, indefinite matrix: the negative
/// pivots of its LDL^T, by Sylvester's law of inertia. For `W - s M` that is the
/// number of eigenvalues of the pencil below s.
///
/// @throws Error  not_converged if a pivot is 0 to rounding, as when s is an eigenvalue
[[nodiscard]] std::int64_t count_negative_eigenvalues(
    const Eigen::SparseMatrix<double>& matrix,
    FactorizationBackend backend = FactorizationBackend::automatic);

}  // namespace timbre
