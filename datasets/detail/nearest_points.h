#pragma once

#include <cstdint>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre::detail {

/// For each row of `from` the nearest row of `to`; ties to the smaller. Compares all with
/// all: for thousands of points, not for more.
[[nodiscard]] std::vector<std::int32_t> nearest_points(const Points& from, const Points& to);

}  // namespace timbre::detail
