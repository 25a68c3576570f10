#include "timbre/analysis/operators/finite_elements.h"

#include <string>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/mesh/sides.h"
#include "timbre/analysis/operators/detail/lagrange_basis.h"

namespace timbre {
namespace {

using Eigen::Index;

Faces faces_with_three_corners(const Faces& faces) {
  Faces kept(faces.rows(), 3);
  Index count = 0;
  for (const auto& face : faces.rowwise()) {
    if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) continue;
    kept.row(count++) = face;
  }
  return kept.topRows(count);
}

// The local number of the first node on the side opposite a corner.
Index first_on_side(Index corner, Index per_edge) { return 3 + corner * per_edge; }

Index corner_of(const Faces& faces, const TriangleSide& side) {
  Index corner = 0;
  while (faces(side.face, corner) != side.apex) ++corner;
  return corner;
}

}  // namespace

LagrangeNodes number_nodes(const Faces& faces, Index vertices, int degree) {
  if (degree < 1 || degree > 3) {
    throw Error(ErrorKind::bad_request, "", "degree", std::to_string(degree) + " is not 1, 2 or 3");
  }
  LagrangeNodes nodes;
  nodes.degree = degree;
  nodes.vertices = vertices;
  nodes.faces = faces_with_three_corners(faces);
  const Index per_edge = degree - 1;
  const Index centres = degree == 3 ? 1 : 0;
  nodes.of_face.resize(nodes.faces.rows(), 3 + 3 * per_edge + centres);
  nodes.of_face.leftCols(3) = nodes.faces;
  const std::vector<TriangleSide> sides = sorted_sides(nodes.faces);
  Index next = vertices;
  for (std::size_t i = 0; i < sides.size();) {
    const std::size_t end = end_of_edge(sides, i);
    nodes.edges.push_back({sides[i].low, sides[i].high});
    for (; i < end; ++i) {
      const Index first = first_on_side(corner_of(nodes.faces, sides[i]), per_edge);
      for (Index step = 0; step < per_edge; ++step) {
        const Index local = sides[i].forward ? step : per_edge - 1 - step;
        nodes.of_face(sides[i].face, first + local) = static_cast<std::int32_t>(next + step);
      }
    }
    next += per_edge;
  }
  for (Index f = 0; centres > 0 && f < nodes.faces.rows(); ++f) {
    nodes.of_face(f, nodes.of_face.cols() - 1) = static_cast<std::int32_t>(next++);
  }
  nodes.size = next;
  return nodes;
}

Points node_positions(const LagrangeNodes& nodes, const Points& vertices) {
  const Eigen::Matrix<double, Eigen::Dynamic, 3> places = detail::lagrange_places(nodes.degree);
  Points positions = Points::Zero(nodes.size, 3);
  positions.topRows(nodes.vertices) = vertices;
  for (Index f = 0; f < nodes.faces.rows(); ++f) {
    for (Index local = 3; local < nodes.of_face.cols(); ++local) {
      positions.row(nodes.of_face(f, local)) = places(local, 0) * vertices.row(nodes.faces(f, 0)) +
                                               places(local, 1) * vertices.row(nodes.faces(f, 1)) +
                                               places(local, 2) * vertices.row(nodes.faces(f, 2));
    }
  }
  return positions;
}

SampledFunction sample_function(const LagrangeNodes& nodes, const Points& vertices,
                                const Eigen::VectorXd& values, int pieces) {
  const Index points = static_cast<Index>(pieces + 1) * (pieces + 2) / 2;
  const Index triangles = static_cast<Index>(pieces) * pieces;
  Eigen::Matrix<double, Eigen::Dynamic, 3> places(points, 3);
  Eigen::MatrixXd basis(points, nodes.of_face.cols());
  Faces pattern(triangles, 3);
  Index point = 0;
  Index triangle = 0;
  for (int row = 0; row <= pieces; ++row) {
    for (int column = 0; row + column <= pieces; ++column, ++point) {
      places.row(point) << pieces - row - column, column, row;
      places.row(point) /= pieces;
      basis.row(point) = detail::lagrange_values(nodes.degree, places.row(point).transpose());
      const auto here = static_cast<std::int32_t>(point);
      const std::int32_t above = here + pieces + 1 - row;
      if (row + column < pieces) pattern.row(triangle++) << here, here + 1, above;
      if (row + column + 1 < pieces) pattern.row(triangle++) << here + 1, above + 1, above;
    }
  }
  SampledFunction sampled;
  sampled.mesh.vertices.resize(points * nodes.faces.rows(), 3);
  sampled.mesh.faces.resize(triangles * nodes.faces.rows(), 3);
  sampled.values.resize(points * nodes.faces.rows());
  for (Index f = 0; f < nodes.faces.rows(); ++f) {
    const Eigen::VectorXd local = values(nodes.of_face.row(f));
    const Eigen::Matrix3d corners = vertices(nodes.faces.row(f), Eigen::all);
    sampled.values.segment(points * f, points) = basis * local;
    sampled.mesh.vertices.middleRows(points * f, points) = places * corners;
    sampled.mesh.faces.middleRows(triangles * f, triangles) =
        pattern.array() + static_cast<std::int32_t>(points * f);
  }
  return sampled;
}

}  // namespace timbre
