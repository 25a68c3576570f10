#include "timbre/analysis/geodesic/geodesic_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "timbre/analysis/geodesic/detail/unit_size.h"
#include "timbre/analysis/mesh/sides.h"

namespace timbre {
namespace {

using Eigen::RowVector3d;

constexpr double kFullAngle = 2.0 * std::numbers::pi;
// Above rounding, below any angle that matters: a path past a vertex that is missed by so
// little is as long as one through it, to all digits.
constexpr double kAngleSlack = 1e-10;

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

std::vector<TriangleSide> sides_without_copies(const Faces& faces) {
  std::vector<TriangleSide> sides = sorted_sides(faces);
  const auto same = [](const TriangleSide& a, const TriangleSide& b) {
    return a.low == b.low && a.high == b.high && a.apex == b.apex;
  };
  sides.erase(std::unique(sides.begin(), sides.end(), same), sides.end());
  return sides;
}

void add_edges(const Points& points, const std::vector<TriangleSide>& sides, GeodesicMesh& mesh) {
  mesh.sides.resize(sides.size());
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    end = end_of_edge(sides, begin);
    const RowVector3d a = points.row(sides[begin].low);
    const RowVector3d along = points.row(sides[begin].high) - a;
    const double length = along.norm();
    const auto edge = static_cast<std::int32_t>(mesh.edges.size());
    mesh.edges.push_back({sides[begin].low, sides[begin].high, static_cast<std::int32_t>(begin),
                          static_cast<std::int32_t>(end), length});
    for (std::size_t s = begin; s < end; ++s) {
      const RowVector3d arm = points.row(sides[s].apex) - a;
      mesh.sides[s].edge = edge;
      mesh.sides[s].apex = sides[s].apex;
      mesh.sides[s].x = length > 0.0 ? arm.dot(along) / length : 0.0;
      mesh.sides[s].y = length > 0.0 ? along.cross(arm).norm() / length : arm.norm();
    }
  }
}

// Links the three sides of each triangle.
void link_triangles(const std::vector<TriangleSide>& sides, Eigen::Index faces,
                    GeodesicMesh& mesh) {
  std::vector<std::array<std::int32_t, 3>> of_face(static_cast<std::size_t>(faces), {-1, -1, -1});
  for (std::size_t s = 0; s < sides.size(); ++s) {
    auto& slots = of_face[at(sides[s].face)];
    *std::find(slots.begin(), slots.end(), -1) = static_cast<std::int32_t>(s);
  }
  for (std::size_t s = 0; s < sides.size(); ++s) {
    for (const std::int32_t other : of_face[at(sides[s].face)]) {
      if (sides[at(other)].apex == sides[s].high) mesh.sides[s].low_side = other;
      if (sides[at(other)].apex == sides[s].low) mesh.sides[s].high_side = other;
    }
  }
}

void list_corners(std::size_t vertices, GeodesicMesh& mesh) {
  mesh.corner_start.assign(vertices + 1, 0);
  for (const GeodesicMesh::Side& side : mesh.sides) ++mesh.corner_start[at(side.apex) + 1];
  std::partial_sum(mesh.corner_start.begin(), mesh.corner_start.end(), mesh.corner_start.begin());
  mesh.corner_sides.resize(mesh.sides.size());
  std::vector<std::int32_t> next(mesh.corner_start.begin(), mesh.corner_start.end() - 1);
  for (std::size_t s = 0; s < mesh.sides.size(); ++s) {
    mesh.corner_sides[at(next[at(mesh.sides[s].apex)]++)] = static_cast<std::int32_t>(s);
  }
}

// The triangle's side across from one of its corners, given any of its sides.
std::int32_t side_across(const GeodesicMesh& mesh, std::int32_t side, std::int32_t corner) {
  const GeodesicMesh::Side& s = mesh.sides[at(side)];
  if (s.apex == corner) return side;
  return mesh.edges[at(s.edge)].low == corner ? s.high_side : s.low_side;
}

// Whether the triangles at v, where each edge has two, are one closed fan.
bool is_one_fan(const GeodesicMesh& mesh, std::int32_t v) {
  const std::int32_t first = mesh.corner_sides[at(mesh.corner_start[at(v)])];
  const std::int32_t count = mesh.corner_start[at(v) + 1] - mesh.corner_start[at(v)];
  std::int32_t corner = first;
  std::int32_t leaves_by = mesh.sides[at(first)].low_side;
  for (std::int32_t steps = 1;; ++steps) {
    const GeodesicMesh::Edge& edge = mesh.edges[at(mesh.sides[at(leaves_by)].edge)];
    const std::int32_t enters_by =
        edge.first_side == leaves_by ? edge.first_side + 1 : edge.first_side;
    corner = side_across(mesh, enters_by, v);
    if (corner == first) return steps == count;
    if (steps == count) return false;
    const GeodesicMesh::Side& side = mesh.sides[at(corner)];
    leaves_by = side.low_side == enters_by ? side.high_side : side.low_side;
  }
}

void find_bends(GeodesicMesh& mesh) {
  const std::size_t n = mesh.corner_start.size() - 1;
  mesh.bends.assign(n, 0);
  std::vector<double> angle(n, 0.0);
  for (const GeodesicMesh::Side& side : mesh.sides) {
    const GeodesicMesh::Edge& edge = mesh.edges[at(side.edge)];
    const bool regular = edge.end_side - edge.first_side == 2;
    if (!regular) mesh.bends[at(edge.low)] = mesh.bends[at(edge.high)] = 1;
    if (!(side.y > 0.0) || !(edge.length > 0.0)) {
      mesh.bends[at(edge.low)] = mesh.bends[at(edge.high)] = mesh.bends[at(side.apex)] = 1;
    }
    const double past = edge.length - side.x;
    angle[at(side.apex)] += std::atan2(side.y * edge.length, side.y * side.y - side.x * past);
  }
  for (std::size_t v = 0; v < n; ++v) {
    if (mesh.corner_start[v] == mesh.corner_start[v + 1] || mesh.bends[v] != 0) continue;
    const bool bends = angle[v] > kFullAngle * (1.0 + kAngleSlack) ||
                       !is_one_fan(mesh, static_cast<std::int32_t>(v));
    mesh.bends[v] = bends ? 1 : 0;
  }
}

}  // namespace

GeodesicMesh make_geodesic_mesh(const TriangleMesh& mesh) {
  GeodesicMesh result;
  detail::UnitSizeMesh sized = detail::at_unit_size(mesh);
  result.unit = sized.unit;
  TriangleMesh& scaled = sized.mesh;
  const std::vector<TriangleSide> sides = sides_without_copies(scaled.faces);
  add_edges(scaled.vertices, sides, result);
  link_triangles(sides, scaled.faces.rows(), result);
  list_corners(static_cast<std::size_t>(mesh.vertices.rows()), result);
  find_bends(result);
  result.graph = make_geodesic_graph(scaled);
  result.vertices = std::move(scaled.vertices);
  return result;
}

}  // namespace timbre
