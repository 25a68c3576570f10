#pragma once

#include <functional>

#include "timbre/analysis/spectrum/detail/pencil.h"

namespace timbre::detail {

/// How well solves with a factor of A = K - s M agree with A itself. Norms are those of S A S,
/// where S scales each row's largest entry to about 1: no unit, and no sliver of a mesh, counts.
struct FactorCheck {
  double backward_error = 0.0;  ///< largest |A x - b| / (|A| |x| + |b|)
  double residual = 0.0;        ///< largest |A x - b| / |b| where b leads to the largest |x|
};

/// Solves in place for `width` right-hand sides, row-major, in the order of the pencil.
using BlockSolve = std::function<void(double* X, int width)>;

/// Two steps of inverse iteration on 8 random vectors, from a fixed seed. They turn towards the
/// eigenvectors of the smallest eigenvalues, which rounding changes the sign of first.
[[nodiscard]] FactorCheck check_factor(const Pencil& pencil, double shift, const BlockSolve& solve);

}  // namespace timbre::detail
