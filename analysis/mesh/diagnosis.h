#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre {

/// Degrees. Thinner triangles are where plain cotangents lose their accuracy.
inline constexpr double kThinAngle = 1.0;

/// What kind of surface a mesh is, and what is odd about it.
///
/// Triangles with a repeated corner are counted as degenerate and otherwise left out, as
/// the Laplace operator leaves them out.
struct Diagnosis {
  std::int64_t vertices = 0;
  std::int64_t faces = 0;
  std::int64_t unused_vertices = 0;  ///< in no triangle
  std::int64_t components = 0;       ///< of triangles joined at vertices
  /// Closed walks along edges of a single triangle; where three or more triangles share an
  /// edge, connected pieces of such edges.
  std::int64_t boundary_loops = 0;
  std::int64_t boundary_edges = 0;
  /// Handles, or cross-caps of a surface that is not orientable; only of one manifold component.
  std::optional<std::int64_t> genus;
  bool manifold = true;            ///< no edge and no vertex counted below
  bool orientable = true;          ///< across all edges of two triangles
  std::int64_t flipped_edges = 0;  ///< of two triangles that run along it the same way

  std::int64_t nonmanifold_edges = 0;  ///< of three or more triangles
  /// At an end of such an edge, or with triangles that form more than one fan.
  std::int64_t nonmanifold_vertices = 0;
  std::int64_t degenerate_faces = 0;     ///< a repeated corner, or no area to rounding
  std::int64_t duplicate_faces = 0;      ///< the corners of an earlier one, in any order
  std::int64_t thin_faces = 0;           ///< with area, and an angle below `kThinAngle`
  std::int64_t coincident_vertices = 0;  ///< exactly at the place of an earlier one

  std::vector<std::array<std::int32_t, 2>> first_boundary_edges;  ///< by vertex numbers
  std::vector<std::array<std::int32_t, 2>> first_nonmanifold_edges;
  std::vector<std::array<std::int32_t, 2>> first_flipped_edges;
  std::vector<std::int32_t> first_nonmanifold_vertices;
  std::vector<std::int32_t> first_degenerate_faces;
  std::vector<std::int32_t> first_duplicate_faces;
  std::vector<std::int32_t> first_thin_faces;
  std::vector<std::int32_t> first_coincident_vertices;
  std::vector<std::int32_t> first_unused_vertices;

  /// Degrees, of triangles with three different corners; 0 where one has no area, 60 at best.
  double smallest_angle = 0.0;
  double shortest_edge = 0.0;  ///< length, of the same; 0 where corners coincide
  double longest_edge = 0.0;
  double mean_edge = 0.0;  ///< over the sides of all triangles
  /// Decimal digits of `mean_edge` that the coordinates hold; few where the origin is far away.
  double digits = 0.0;
  double area = 0.0;  ///< length^2; infinite where a double cannot hold it
  /// length^3, of closed orientable meshes; each component turned as most of its triangles are.
  std::optional<double> volume;
};

/// Examines a mesh in O(n log n), whatever its shape.
/// @param listed  the length at which lists of places end
[[nodiscard]] Diagnosis diagnose(const TriangleMesh& mesh, std::size_t listed = 5);

}  // namespace timbre
