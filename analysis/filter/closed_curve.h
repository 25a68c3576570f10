#pragma once

#include <Eigen/Core>
#include <complex>

#include "timbre/analysis/operators/operator.h"
#include "timbre/analysis/spectrum/spectrum.h"

namespace timbre {

// Closed curves of n points in the plane, and the n-periodic signals on them: section 1 of the
// course (Levy and Zhang 2009). Eigenfunctions count from 0 here, from 1 there. With
// `closed_curve_spectrum` and the mass of `closed_curve_operator`, all that this room does for
// surfaces it does for curves: transform, filters, reconstruction and its error.

/// The one-dimensional Laplacian of equation 3 as stiffness (1 on the diagonal, -1/2 beside it),
/// and the identity as mass. It knows n alone: all segments count alike.
/// @throws Error  bad_request if n < 3
[[nodiscard]] Operator closed_curve_operator(Eigen::Index n);

/// Its lowest eigenpairs in closed form: `lambda_i = 1 - cos(2 pi m / n) = 2 sin^2(pi m / n)` with
/// the frequency m = ceil(i / 2) (equation 9), and the real basis of the discrete Fourier
/// transform, normalised: constant; then for each m the cosine of 2 pi m j / n, and its sine, up to
/// n / 2, whose sine is nothing. Double but for the first and, for even n, the last.
/// @param count  1 to n
/// @throws Error  bad_request if n < 3 or count is not in its range
[[nodiscard]] Spectrum closed_curve_spectrum(Eigen::Index n, Eigen::Index count);

/// Laplacian smoothing, `count` times: each point moves by `step` times the vector to the middle of
/// its neighbours (equations 2 and 4; one half, as there, is midpoint smoothing twice). The same as
/// the filter `smoothing_steps(step, count)`. Steps in (0, 1) shrink the curve to its centroid;
/// those up to 1/2 so that, seen at its own size, it becomes the reconstruction from the lowest
/// three eigenfunctions, an affine image of a regular polygon.
/// @throws Error  bad_request if there are less than 3 points, or count < 0
[[nodiscard]] Eigen::MatrixX2d smooth_closed_curve(Eigen::MatrixX2d points, double step, int count);

/// The discrete Fourier transform from all n coefficients of `closed_curve_spectrum(n, n)`:
/// `X(m) = 1/n sum_j x_j e^(-2 pi i m j / n)`, section 1.5. With c the coefficients,
/// X(0) = c_0 / sqrt(n), X(m) = (c_(2m-1) - i c_2m) / sqrt(2 n) for 0 < m < n / 2, for even n
/// X(n/2) = c_(n-1) / sqrt(n), and X(n - m) the conjugate of X(m).
/// @param coefficients  n x d
/// @return              n x d
[[nodiscard]] Eigen::MatrixXcd to_dft(const Eigen::MatrixXd& coefficients);

}  // namespace timbre
