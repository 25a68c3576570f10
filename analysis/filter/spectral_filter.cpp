#include "timbre/analysis/filter/spectral_filter.h"

#include <cmath>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"
#include "timbre/analysis/filter/spectral_transform.h"

namespace timbre {
namespace {

Eigen::VectorXd factors_of(const Eigen::VectorXd& values, const Transfer& transfer) {
  Eigen::VectorXd factors(values.size());
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    factors[i] = transfer(values[i]);
    if (std::isfinite(factors[i])) continue;
    throw Error(ErrorKind::bad_request, "", "transfer",
                "is not finite at the eigenvalue " + to_text(values[i]));
  }
  return factors;
}

}  // namespace

Eigen::MatrixXd apply_filter(const Spectrum& spectrum, const SparseMatrix& mass,
                             const Eigen::MatrixXd& F, const Transfer& transfer,
                             const FilterOptions& options) {
  const Eigen::VectorXd factors = factors_of(spectrum.values, transfer);
  const Eigen::MatrixXd coefficients = forward_transform(spectrum, mass, F);
  // Both sums in one; where all factors are those of the detail nothing is added to it.
  const Eigen::VectorXd beside = factors.array() - options.detail;
  Eigen::MatrixXd filtered =
      options.detail * F + inverse_transform(spectrum, beside.asDiagonal() * coefficients);
  const Eigen::VectorXd diagonal = mass.diagonal();
  for (Eigen::Index i = 0; i < F.rows(); ++i) {
    if (diagonal[i] == 0.0) filtered.row(i) = F.row(i);
  }
  return filtered;
}

// Eigenfunctions and the detail are orthogonal: squares add up.
double relative_change(const Spectrum& spectrum, const Reconstruction& parts,
                       const Transfer& transfer, const FilterOptions& options) {
  const Eigen::ArrayXd lost = 1.0 - factors_of(spectrum.values, transfer).array();
  const double detail_lost = 1.0 - options.detail;
  const double squares =
      (lost.square() * parts.energies.array()).sum() + detail_lost * detail_lost * parts.detail;
  return parts.variation > 0.0 ? std::sqrt(squares) / parts.variation : 0.0;
}

}  // namespace timbre
