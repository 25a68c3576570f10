#include "timbre/analysis/signatures/wave_kernel.h"

#include <cmath>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/matrix_product.h"

namespace timbre {

WaveKernelBands wave_kernel_bands(const Spectrum& spectrum, const WaveKernelOptions& options) {
  if (options.energies < 2 || !(options.width > 0.0)) {
    throw Error(ErrorKind::bad_request, "", "wave kernel",
                "needs at least 2 energies and a positive width");
  }
  const Eigen::Index count = spectrum.values.size();
  const double first = spectrum.zeros < count ? std::log(spectrum.values(spectrum.zeros)) : 0.0;
  const double last = spectrum.zeros < count ? std::log(spectrum.values(count - 1)) / 1.02 : 0.0;
  if (!(last > first)) {
    throw Error(ErrorKind::bad_request, "", "wave kernel",
                "the eigenvalues lie too close together; ask for more eigenpairs");
  }
  return {Eigen::VectorXd::LinSpaced(options.energies, first, last),
          options.width * (last - first) / (options.energies - 1)};
}

Eigen::MatrixXd compute_wave_kernel_signature(const Spectrum& spectrum,
                                              const WaveKernelBands& bands) {
  const Eigen::Index used = spectrum.values.size() - spectrum.zeros;
  const Eigen::ArrayXd levels = spectrum.values.tail(used).array().log();
  Eigen::MatrixXd weights(used, bands.energies.size());
  for (Eigen::Index e = 0; e < weights.cols(); ++e) {
    weights.col(e) = (-0.5 * ((levels - bands.energies(e)) / bands.sigma).square()).exp();
    weights.col(e) /= weights.col(e).sum();
  }
  return product_a_b(spectrum.vectors.rightCols(used).cwiseAbs2(), weights);
}

}  // namespace timbre
