#pragma once

#include <cstdint>
#include <vector>

#include "timbre/analysis/spectrum/detail/tile_kernels.h"

namespace timbre::detail {

/// What the pivots say about the matrix.
struct PivotCounts {
  std::int64_t negative = 0;    ///< negative eigenvalues of D
  std::int64_t two_by_two = 0;  ///< 2 x 2 blocks in D
  std::int64_t replaced = 0;    ///< pivots too small to divide by, replaced by rounding's size
  double smallest = 1.0;        ///< least |pivot| beside the largest entry of its row in the matrix

  void add(const PivotCounts& other);
};

/// The factor of one diagonal block: P A P^T = L D L^T, `width` columns, at most kPanelWidth.
struct DiagonalBlock {
  int* order;       ///< width: row i of P A P^T is row order[i] of A
  double* d;        ///< width: diagonal of D^-1
  double* e;        ///< width: D^-1(k + 1, k), 0 between blocks
  double* inverse;  ///< L^-1 in padded tiles, 8 padded(width) apart
};

/// Factorises the lower triangle of a block with 1 x 1 and 2 x 2 pivots chosen inside it (Bunch
/// and Kaufman 1977; restricted to blocks as by Schenk and Gaertner 2006). A pivot that is 0
/// beside the matrix's own entries is replaced by one of rounding's size, and counted.
///
/// @param A      padded(width) columns of that length, zero beyond `width`; overwritten
/// @param scale  width: the largest entry of each row of the matrix
/// @param work   padded(width)^2 values
PivotCounts factorize_block(const TileKernels& kernels, double* A, int width, const double* scale,
                            double* work, const DiagonalBlock& out);

}  // namespace timbre::detail
