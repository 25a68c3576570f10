#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre {

/// Where piecewise polynomials of degree 1, 2 or 3 on triangles have their values: at vertices,
/// at degree - 1 points that part each edge evenly, and for degree 3 at the centre of each
/// triangle. They are numbered in this order: vertex i is node i; then the edges, sorted by
/// (smaller, larger vertex), each from its smaller vertex on; then the triangles.
struct LagrangeNodes {
  int degree = 1;
  Eigen::Index vertices = 0;
  Eigen::Index size = 0;                           ///< all nodes
  std::vector<std::array<std::int32_t, 2>> edges;  ///< (smaller, larger vertex)
  Faces faces;                                     ///< m' x 3: those without a repeated corner

  /// m' x (3, 6 or 10): corners 0 to 2; nodes of the side from corner 1 to 2, of that from 2 to
  /// 0, of that from 0 to 1; the centre.
  Eigen::Matrix<std::int32_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> of_face;
};

/// @throws Error  bad_request unless degree is 1, 2 or 3
[[nodiscard]] LagrangeNodes number_nodes(const Faces& faces, Eigen::Index vertices, int degree);

/// @return nodes.size x 3
[[nodiscard]] Points node_positions(const LagrangeNodes& nodes, const Points& vertices);

/// A piecewise polynomial made linear on small triangles, to be drawn.
struct SampledFunction {
  TriangleMesh mesh;
  Eigen::VectorXd values;
};

/// Cuts each triangle into `pieces`^2 and evaluates the polynomial at their corners. The small
/// triangles of different triangles share no vertices.
/// @param values  one for each node
[[nodiscard]] SampledFunction sample_function(const LagrangeNodes& nodes, const Points& vertices,
                                              const Eigen::VectorXd& values, int pieces);

}  // namespace timbre
