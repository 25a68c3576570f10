#include "timbre/analysis/spectrum/factorization.h"

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/spectrum/detail/supernodal_ldlt.h"

namespace timbre {

bool has_cholmod() {
#ifdef TIMBRE_WITH_CHOLMOD
  return true;
#else
  return false;
#endif
}

struct Factorization::Impl {
  explicit Impl(const Eigen::SparseMatrix<double>& matrix)
      : ldlt(matrix, Eigen::SparseMatrix<double>(matrix.rows(), matrix.cols()), nullptr,
             {.check = false}) {}

  detail::SupernodalLdlt ldlt;
};

Factorization::Factorization(const Eigen::SparseMatrix<double>& matrix)
    : impl_(std::make_unique<Impl>(matrix)) {
  const detail::LdltReport report = impl_->ldlt.factorize(0.0);
  if (report.negative == 0 && report.replaced == 0) return;
  throw Error(ErrorKind::not_converged, "", "factorisation", "the matrix is not positive definite");
}

Factorization::~Factorization() = default;
Factorization::Factorization(Factorization&&) noexcept = default;
Factorization& Factorization::operator=(Factorization&&) noexcept = default;

void Factorization::solve(Eigen::Ref<Eigen::MatrixXd> X) const { impl_->ldlt.solve(X); }

}  // namespace timbre
