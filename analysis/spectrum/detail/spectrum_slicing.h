#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <functional>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre::detail {

struct SlicingOptions {
  Eigen::Index count = 100;                ///< pairs wanted, from the lowest; below n / 4
  double tolerance = 1e-9;                 ///< of a pair, beside |lambda| + the largest wanted
  int half = 50;                           ///< pairs on each side of a shift, about
  int width = 0;                           ///< of blocks, 8 or 16; 0: chosen by count
  std::uint64_t seed = 1;                  ///< of start vectors
  std::function<void(int)> on_solve = {};  ///< after so many solves with a factor; may throw
};

/// One shift and what was found around it.
struct SliceReport {
  double shift = 0.0;
  std::int64_t below = 0;  ///< eigenvalues below the shift, by inertia
  int accepted = 0;        ///< pairs taken from this band
  int runs = 0;            ///< of the iteration; more than 1 after a repair
};

struct SlicedPairs {
  Eigen::VectorXd values;   ///< ascending; at least `count`, all that were found below `bound`
  Eigen::MatrixXd vectors;  ///< n x values, M-orthonormal
  double bound = 0.0;       ///< exactly as many eigenvalues as `values` lie below, by inertia
  std::vector<SliceReport> slices;
};

/// The lowest eigenpairs of K x = lambda M x, band by band: a shift inside the spectrum, its
/// inertia count, block Lanczos around it, and a cut in a gap where the next band begins
/// (spectrum slicing: Parlett 1980, section 3.3; Grimes, Lewis and Simon 1994). All pairs between
/// two shifts are there when their number is what the counts say; where copies of a multiple
/// eigenvalue are missing, they are looked for beside those known.
///
/// @param K          n x n, symmetric, positive semi-definite
/// @param M          n x n, symmetric, positive definite; about sum(M) / (4 pi) eigenvalues are
///                   expected in a unit interval (Weyl)
/// @param positions  n x 3 for a geometric ordering, or nullptr
/// @throws Error  not_converged if the counts cannot be met
[[nodiscard]] SlicedPairs lowest_pairs(const Eigen::SparseMatrix<double>& K,
                                       const Eigen::SparseMatrix<double>& M,
                                       const Points* positions, const SlicingOptions& options);

}  // namespace timbre::detail
