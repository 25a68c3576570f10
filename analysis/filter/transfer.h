#pragma once

#include <Eigen/Core>
#include <functional>

namespace timbre {

/// What a filter multiplies the part of a function at an eigenvalue by. A function of the
/// eigenvalue alone treats all of an eigenspace alike: its result does not depend on which basis
/// of it, or which signs, the solver found.
using Transfer = std::function<double(double lambda)>;

/// 1 up to `cutoff` and there, 0 above.
[[nodiscard]] Transfer low_pass(double cutoff);

/// `inside` from `low` to `high`, both included, `outside` elsewhere: (1, 0) lets a band pass,
/// (0, 1) takes it out, (2, 1) doubles it.
/// @throws Error  bad_request if low > high or a factor is not finite
[[nodiscard]] Transfer band(double low, double high, double inside, double outside);

/// e^(-lambda time): the function after it was left to the heat equation for that long.
/// @param time  length^2
/// @throws Error  bad_request if time < 0
[[nodiscard]] Transfer heat(double time);

/// (1 - step lambda)^count: so many explicit steps of Laplacian smoothing, `F -= step M^-1 W F`.
/// Smoothing while step is below 2 / lambda_max.
/// @throws Error  bad_request if count < 0
/// @see Levy and Zhang 2009, equation 8
[[nodiscard]] Transfer smoothing_steps(double step, int count);

/// Straight lines between points; before the first and after the last as there.
/// @param points  rows of (lambda, factor), lambda ascending
/// @throws Error  bad_input, with the point, if there is none, a number is not finite, or lambda
///                does not grow
[[nodiscard]] Transfer piecewise_linear(const Eigen::MatrixX2d& points);

}  // namespace timbre
