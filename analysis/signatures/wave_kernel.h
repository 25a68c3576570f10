#pragma once

#include <Eigen/Core>

#include "timbre/analysis/spectrum/spectrum.h"

namespace timbre {

struct WaveKernelOptions {
  int energies = 100;  ///< columns, at least 2
  double width = 7.0;  ///< standard deviation of the band, in steps of energy; positive
};

/// Energies e and the width of the band, both in log lambda.
struct WaveKernelBands {
  Eigen::VectorXd energies;  ///< evenly spaced over [log lambda_min, log lambda_max / 1.02]
  double sigma = 0.0;
};

/// @throws Error  bad_request for options out of range, or if the eigenvalues that are
///                not zero span no interval of energies
[[nodiscard]] WaveKernelBands wave_kernel_bands(const Spectrum& spectrum,
                                                const WaveKernelOptions& options = {});

/// Wave kernel signature: for each energy e the mean of phi_i(x)^2 with weights
/// exp(-(e - log lambda_i)^2 / (2 sigma^2)), one row per vertex, one column per energy,
/// over the eigenvalues that are not zero. Meant for unit area: pass `at_unit_area(...)`.
///
/// Does not see signs and rotations inside an eigenspace, except in one that the end
/// of the spectrum cuts.
/// @see Aubry, Schlickewei and Cremers 2011, section 4
[[nodiscard]] Eigen::MatrixXd compute_wave_kernel_signature(const Spectrum& spectrum,
                                                            const WaveKernelBands& bands);

}  // namespace timbre
