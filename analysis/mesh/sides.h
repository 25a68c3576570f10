#pragma once

#include <cstdint>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre {

/// One side of a triangle: the edge it lies on, and where it lies.
struct TriangleSide {
  std::int32_t low = 0;   ///< the edge's smaller vertex
  std::int32_t high = 0;  ///< the larger
  std::int32_t apex = 0;  ///< the triangle's third corner
  std::int32_t face = 0;
  bool forward = false;  ///< the triangle runs from `low` to `high`
};

/// The sides of all triangles without a repeated corner, sorted by edge, so that the
/// sides on one edge stand together; then by apex and face.
[[nodiscard]] std::vector<TriangleSide> sorted_sides(const Faces& faces);

/// One past the last side on the same edge as the side at `begin`.
[[nodiscard]] std::size_t end_of_edge(const std::vector<TriangleSide>& sides, std::size_t begin);

}  // namespace timbre
