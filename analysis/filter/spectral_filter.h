#pragma once

#include <Eigen/Core>

#include "timbre/analysis/filter/reconstruction.h"
#include "timbre/analysis/filter/transfer.h"
#include "timbre/analysis/spectrum/spectrum.h"

namespace timbre {

struct FilterOptions {
  /// What multiplies the detail, the part of the functions that lies beyond the eigenfunctions
  /// given, whose eigenvalues are not known: 0 drops it, 1 keeps it as it is,
  /// `transfer(spectrum.values.tail<1>()[0])` goes on as the filter ends.
  double detail = 0.0;
};

/// Filters functions: `Phi f(Lambda) Phi^T M F + detail (F - Phi Phi^T M F)`.
///
/// An eigenspace that is cut by the end of the spectrum is the one case in which the result depends
/// on the solver's basis; `relative_gap` shows it.
///
/// @param mass  N x N, in which the eigenfunctions are orthonormal: `Operator::mass`
/// @param F     N x d
/// @return      N x d; rows that have no part in the operator are those of F
/// @throws Error  bad_request if the sizes do not agree, or the transfer function is not finite at
///                an eigenvalue
/// @see Levy and Zhang 2009, section 1.4; Vallet and Levy 2008, which keep the detail or scale it
[[nodiscard]] Eigen::MatrixXd apply_filter(const Spectrum& spectrum, const SparseMatrix& mass,
                                           const Eigen::MatrixXd& F, const Transfer& transfer,
                                           const FilterOptions& options = {});

/// How far the filter moves the functions: the norm of `apply_filter(F) - F` over their variation,
/// from what is known of F already; 0 if they do not vary.
/// @param parts  `analyse_reconstruction` of the same spectrum and F
/// @throws Error  bad_request if the transfer function is not finite at an eigenvalue
[[nodiscard]] double relative_change(const Spectrum& spectrum, const Reconstruction& parts,
                                     const Transfer& transfer, const FilterOptions& options = {});

}  // namespace timbre
