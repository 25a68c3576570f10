#pragma once

#include <cstdint>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre::detail {

/// For each row of `from` the nearest row of `to`; ties to the smaller. For points spread
/// over a surface a query looks at about n^(1/2) of them.
[[nodiscard]] std::vector<std::int32_t> nearest_points(const Points& from, const Points& to);

}  // namespace timbre::detail
