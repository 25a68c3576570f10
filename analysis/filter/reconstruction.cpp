#include "timbre/analysis/filter/reconstruction.h"

#include <algorithm>
#include <cmath>

#include "timbre/analysis/filter/spectral_transform.h"

namespace timbre {
namespace {

constexpr double kRounding = 1e-13;  // variation of constants, in their own size

}  // namespace

Reconstruction analyse_reconstruction(const Spectrum& spectrum, const SparseMatrix& mass,
                                      const Eigen::MatrixXd& F) {
  const Eigen::MatrixXd coefficients = forward_transform(spectrum, mass, F);
  const Eigen::MatrixXd beyond = F - inverse_transform(spectrum, coefficients);
  Reconstruction found;
  found.energies = coefficients.rowwise().squaredNorm();
  found.detail = std::max(0.0, beyond.cwiseProduct(mass * beyond).sum());

  const Eigen::Index k = found.energies.size();
  found.errors.resize(k + 1);
  double missed = found.detail;
  for (Eigen::Index j = k; j >= 0; --j) {
    found.errors[j] = std::sqrt(missed);
    if (j > 0) missed += found.energies[j - 1];
  }
  found.variation = found.errors[std::min<Eigen::Index>(spectrum.zeros, k)];
  if (found.variation <= kRounding * found.errors[0]) found.variation = 0.0;
  if (found.variation > 0.0) {
    found.errors /= found.variation;
  } else {
    found.errors.setZero();
  }
  return found;
}

}  // namespace timbre
