#pragma once

#include <Eigen/Core>

#include "timbre/analysis/spectrum/spectrum.h"

namespace timbre {

/// `count` times spaced evenly in the logarithm over
/// [4 ln 10 / lambda_max, 4 ln 10 / lambda_min], the largest and the smallest
/// eigenvalue that is not zero: at these ends e^(-lambda t) is 1e-4.
/// @throws Error  bad_request if count < 1 or all eigenvalues are zero
[[nodiscard]] Eigen::VectorXd heat_kernel_times(const Spectrum& spectrum, int count = 64);

struct HeatKernelOptions {
  /// Divide by sum_i e^(-lambda_i t), so that all times weigh alike. Without, one
  /// column is the auto-diffusion function.
  bool divide_by_trace = true;
};

/// Heat kernel signature: h(x, t) = sum_i e^(-lambda_i t) phi_i(x)^2, one row per
/// vertex and one column per time, over the eigenvalues that are not zero.
///
/// A sum of squares over an eigenspace does not see signs and rotations in it. An
/// eigenspace cut by the end of the spectrum is seen, weakly: it enters with e^(-lambda t)
/// <= 1e-4 for the times above. Pass `at_unit_area(...)` to be blind to scale.
///
/// @param times  length^2, positive
/// @throws Error  bad_request if all eigenvalues are zero
/// @see Sun, Ovsjanikov and Guibas 2009
[[nodiscard]] Eigen::MatrixXd compute_heat_kernel_signature(const Spectrum& spectrum,
                                                            const Eigen::VectorXd& times,
                                                            const HeatKernelOptions& options = {});

}  // namespace timbre
