#pragma once

#include <cstdint>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre {

/// Points spread evenly: each next one is the farthest, in a straight line, from all before;
/// of equally far ones the one with the smallest number.
///
/// @param count  at least 1, at most the number of points
/// @param start  the first of them
/// @return `count` different point numbers, in the order chosen; O(count n)
/// @throws Error  bad_request if `count` or `start` is out of range
/// @see Eldar et al. 1997 (farthest point strategy)
[[nodiscard]] std::vector<std::int32_t> farthest_points(const Points& points, std::int32_t count,
                                                        std::int32_t start = 0);

}  // namespace timbre
