#pragma once

#include <Eigen/Core>

#include "timbre/analysis/spectrum/spectrum.h"

namespace timbre {

/// The forward transform: coefficients `C = Phi^T M F` of functions in the eigenfunctions.
///
/// @param mass  N x N, in which the eigenfunctions are orthonormal: `Operator::mass`, diagonal or
///              not
/// @param F     N x d, a function in each column: the coordinates, say, with d = 3
/// @return      k x d; the unit of F times length
/// @throws Error  bad_request if the sizes do not agree
/// @see Levy and Zhang 2009, equations 5 and 6; Vallet and Levy 2008 (manifold harmonic transform)
[[nodiscard]] Eigen::MatrixXd forward_transform(const Spectrum& spectrum, const SparseMatrix& mass,
                                                const Eigen::MatrixXd& F);

/// The inverse: `Phi C`, the functions that have these coefficients. Fewer rows than eigenfunctions
/// stand for the lowest: the reconstruction from so many of them.
///
/// @param coefficients  at most k x d
/// @return              N x d; 0 on rows that have no part in the operator
/// @throws Error  bad_request if there are more coefficients than eigenfunctions
/// @see Levy and Zhang 2009, equation 7
[[nodiscard]] Eigen::MatrixXd inverse_transform(const Spectrum& spectrum,
                                                const Eigen::MatrixXd& coefficients);

}  // namespace timbre
