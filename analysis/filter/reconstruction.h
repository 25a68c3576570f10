#pragma once

#include <Eigen/Core>

#include "timbre/analysis/spectrum/spectrum.h"

namespace timbre {

/// How much of functions lies along each eigenfunction, and so what a reconstruction from the
/// lowest of them misses. Squared norms are `tr F^T M F`: over all columns together.
struct Reconstruction {
  Eigen::VectorXd energies;  ///< k, squared norm along each eigenfunction
  double detail = 0.0;       ///< squared norm of what lies beyond all k
  double variation = 0.0;    ///< norm of what constants miss: of the functions less their means
  /// k + 1; errors(j) is the norm of what the lowest j eigenfunctions miss, over `variation`:
  /// errors(zeros) = 1. All 0 for functions that do not vary.
  Eigen::VectorXd errors;
};

/// All at once, from one transform. Sums start with the detail and never subtract: small errors
/// keep their digits.
///
/// @param mass  N x N, in which the eigenfunctions are orthonormal: `Operator::mass`
/// @param F     N x d; rows that have no part in the operator do not count
/// @throws Error  bad_request if the sizes do not agree
/// @see Levy and Zhang 2009, section 1.3
[[nodiscard]] Reconstruction analyse_reconstruction(const Spectrum& spectrum,
                                                    const SparseMatrix& mass,
                                                    const Eigen::MatrixXd& F);

}  // namespace timbre
