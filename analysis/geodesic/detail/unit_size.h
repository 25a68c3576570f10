#pragma once

#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre::detail {

struct UnitSizeMesh {
  TriangleMesh mesh;  ///< near the origin, of a size near 1
  double unit = 1.0;  ///< one length of it in the former unit; a power of two, rounds nothing
};

[[nodiscard]] UnitSizeMesh at_unit_size(const TriangleMesh& mesh);

}  // namespace timbre::detail
