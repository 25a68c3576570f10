#pragma once

#include <cstdint>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"
#include "timbre/analysis/operators/detail/surface.h"

namespace timbre::detail {

/// Triangles by lengths, glued along edges. Halfedge h = 3 f + c runs from corner c of triangle
/// f to its next corner. An edge may join a vertex to itself, two edges the same pair.
struct IntrinsicTriangulation {
  std::vector<std::int32_t> tail;  ///< 3 a triangle: the vertex a halfedge leaves
  std::vector<std::int32_t> twin;  ///< the halfedge on the other side, -1 at a boundary
  std::vector<double> length;
  double share = 1.0;  ///< of a triangle's weights: 1/2 where each face has two sides here
};

/// The faces as they are, if each edge has at most two and these run along it in opposite
/// directions; without triangles otherwise.
[[nodiscard]] IntrinsicTriangulation oriented_sheet(const Surface& surface);

/// The tufted cover: two copies of each face, front and back, glued into a closed and oriented
/// surface on the same vertices, whatever the mesh. About an edge, the side of one face is glued
/// to the side of the next face that it looks at. A boundary edge joins front and back.
///
/// Where three or more faces meet, the result hangs on their order about the edge. Angles nearer
/// than 1e-7 of a turn count as equal, and ties go by position: else rounding and numbering
/// would decide.
///
/// @param positions  n x 3 to measure the angles in; null: faces about an edge stand in the
///                   order of their third corners
/// @see Sharp and Crane 2020, section 4.2
[[nodiscard]] IntrinsicTriangulation tufted_cover(const Surface& surface, const Points* positions);

}  // namespace timbre::detail
