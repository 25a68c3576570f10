#pragma once

#include <cstdint>
#include <vector>

#include "timbre/analysis/geodesic/graph.h"
#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre {

/// A mesh as exact distances want it: edges, the triangles on each laid into the plane, and
/// the graph whose distances bound them. Made once, read by any number of threads.
///
/// Triangles with a repeated corner are left out, and of those with the same three corners
/// all but the first, which could only repeat its paths.
struct GeodesicMesh {
  struct Edge {
    std::int32_t low = 0;   ///< the smaller vertex; positions on the edge count from here
    std::int32_t high = 0;  ///< the larger
    std::int32_t first_side = 0;
    std::int32_t end_side = 0;  ///< its triangles are sides [first_side, end_side); any number
    double length = 0.0;        ///< >= 0
  };
  /// A triangle on one of its edges: `low` at (0, 0), `high` at (length, 0), apex at (x, y).
  struct Side {
    std::int32_t edge = 0;
    std::int32_t apex = 0;
    std::int32_t low_side = 0;   ///< the same triangle on the edge from `low` to the apex
    std::int32_t high_side = 0;  ///< and on the one from `high` to the apex
    double x = 0.0;
    double y = 0.0;  ///< >= 0
  };

  Points vertices;  ///< n x 3, moved near the origin
  std::vector<Edge> edges;
  std::vector<Side> sides;                 ///< sorted by edge
  std::vector<std::int32_t> corner_start;  ///< n + 1: v is the apex of sides
  std::vector<std::int32_t> corner_sides;  ///< corner_sides[corner_start[v], corner_start[v+1])
  /// n, 1 where shortest paths may bend: the angle is above 2 pi, or v is on a boundary, on
  /// an edge of more than two triangles, on one without area, or where sheets only touch.
  std::vector<std::uint8_t> bends;
  GeodesicGraph graph;
  double unit = 1.0;  ///< a power of two; all lengths above are in this many of the mesh's units

  [[nodiscard]] Eigen::Index size() const { return graph.size(); }
};

/// Any triangle mesh; neither a far origin nor an extreme unit of length costs digits.
[[nodiscard]] GeodesicMesh make_geodesic_mesh(const TriangleMesh& mesh);

}  // namespace timbre
