#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "timbre/analysis/operators/operator.h"

namespace timbre::detail {

/// A number for the entries (a, b) and (b, a) of a symmetric matrix; b may be a, for one entry.
struct MatrixPair {
  std::int32_t a = 0;
  std::int32_t b = 0;
  double value = 0.0;
};

/// Adds up all pairs, and the diagonal where it is not 0. Symmetric to the bit: both entries of
/// a pair are sums in the same order. Linear in the number of pairs.
/// @param diagonal  n
[[nodiscard]] SparseMatrix symmetric_matrix(const std::vector<MatrixPair>& pairs,
                                            const Eigen::VectorXd& diagonal);

/// The Laplacian of weighted edges, sum_j w_ij (u_i - u_j): each edge is summed once and used
/// for (i, j), (j, i) and both diagonals, so that the rows add up to 0 up to the rounding of one
/// sum. Loops (a = b) count for nothing.
[[nodiscard]] SparseMatrix laplacian_of_edges(std::vector<MatrixPair> weights, Eigen::Index n);

}  // namespace timbre::detail
