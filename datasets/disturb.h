#pragma once

#include <cstdint>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"
#include "timbre/datasets/random.h"

namespace timbre {

// What scanners and editors do to meshes, done on purpose. Random numbers decide where.

/// Moves each vertex in a random direction; indices stay.
/// @param strength  root mean square of the moves, in mean edge lengths; at least 0
[[nodiscard]] TriangleMesh add_noise(const TriangleMesh& mesh, double strength, Random& random);

/// What is left of a mesh.
struct MeshPart {
  TriangleMesh mesh;
  std::vector<std::int32_t> original;  ///< for each vertex its number before; ascending
};

/// Takes out the triangles of `count` geodesic discs, which may overlap, and then all but
/// the largest component.
/// @param share  of the whole area that each disc holds; count * share below 0.9
/// @throws Error  bad_request for other shares, or a mesh without triangles
[[nodiscard]] MeshPart punch_holes(const TriangleMesh& mesh, int count, double share,
                                   Random& random);

/// Cuts by a plane of random direction and keeps the largest component of one side.
/// @param keep  share of the area on that side, between 0.1 and 0.9
/// @throws Error  bad_request for another share, or a mesh without triangles
[[nodiscard]] MeshPart cut_by_plane(const TriangleMesh& mesh, double keep, Random& random);

/// Grows two places together that are near in space but far along the surface: the triangles
/// there give way to a bridge of six. Indices stay, the genus rises by one.
/// @throws Error  bad_input if no two such places are there
[[nodiscard]] TriangleMesh weld_contact(const TriangleMesh& mesh);

}  // namespace timbre
