#pragma once

#include <cstdint>
#include <vector>

#include "timbre/analysis/operators/detail/surface.h"
#include "timbre/analysis/operators/detail/symmetric_matrix.h"

namespace timbre::detail {

/// The edges and triangles of a surface after intrinsic Delaunay flips.
struct DelaunayElements {
  std::vector<MatrixPair> weights;  ///< half the cotangents of each edge, 0 or more
  std::vector<MetricFace> faces;    ///< corners may repeat
  double share = 1.0;  ///< to multiply what comes of `faces` with; in `weights` already
  std::int64_t flips = 0;
};

/// Of the tufted cover, or of the surface itself where that gives the same for half the work.
/// @param positions  n x 3, or null if only lengths are known
/// @see Sharp and Crane 2020
[[nodiscard]] DelaunayElements delaunay_elements(const Surface& surface, const Points* positions);

}  // namespace timbre::detail
