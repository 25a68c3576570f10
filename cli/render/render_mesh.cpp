#include "timbre/cli/render/render_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/mesh/orientation.h"
#include "timbre/analysis/mesh/sides.h"

namespace timbre::cli {
namespace {

using Eigen::Index;

Error nothing_to_draw() {
  return {ErrorKind::bad_input, "", "", "no triangle has an area; there is nothing to draw"};
}

// To [-1, 1]^3. Halves, because the extent of a mesh may be beyond a double.
Points to_unit_cube(const TriangleMesh& mesh) {
  Eigen::RowVector3d low = Eigen::RowVector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::RowVector3d high = -low;
  for (const std::int32_t v : mesh.faces.reshaped()) {
    low = low.cwiseMin(mesh.vertices.row(v));
    high = high.cwiseMax(mesh.vertices.row(v));
  }
  const Eigen::RowVector3d middle = 0.5 * low + 0.5 * high;
  const double extent = (0.5 * high - 0.5 * low).maxCoeff();
  if (!(extent > 0.0)) throw nothing_to_draw();
  return (mesh.vertices.rowwise() - middle) / extent;
}

// Twice the area, along the normal.
Eigen::Vector3d area_vector(const Points& points, const Faces& faces, Index f) {
  const Eigen::Vector3d a = points.row(faces(f, 0));
  const Eigen::Vector3d b = points.row(faces(f, 1));
  const Eigen::Vector3d c = points.row(faces(f, 2));
  return (b - a).cross(c - a);
}

// Without those so thin that rounding decides where their normal points.
Faces with_area(const Points& points, const Faces& faces) {
  constexpr double kThinnest = 1e-9;
  Faces kept(faces.rows(), 3);
  Index count = 0;
  for (Index f = 0; f < faces.rows(); ++f) {
    double longest = 0.0;
    for (int c = 0; c < 3; ++c) {
      longest = std::max(
          longest, (points.row(faces(f, c)) - points.row(faces(f, (c + 1) % 3))).squaredNorm());
    }
    const double area = area_vector(points, faces, f).norm();
    if (area > kThinnest * longest) kept.row(count++) = faces.row(f);
  }
  kept.conservativeResize(count, 3);
  return kept;
}

// Corners that share a normal, as a forest whose roots stand for the groups.
class CornerGroups {
 public:
  explicit CornerGroups(Index corners) : parent_(static_cast<std::size_t>(corners)) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  std::int64_t root(std::int64_t corner) {
    while (parent(corner) != corner) corner = parent(corner) = parent(parent(corner));
    return corner;
  }

  void join(std::int64_t a, std::int64_t b) {
    a = root(a);
    b = root(b);
    parent(std::max(a, b)) = std::min(a, b);
  }

 private:
  std::int64_t& parent(std::int64_t corner) { return parent_[static_cast<std::size_t>(corner)]; }

  std::vector<std::int64_t> parent_;
};

std::int64_t corner_at(const Faces& faces, std::int32_t face, std::int32_t vertex) {
  int c = 0;
  while (faces(face, c) != vertex) ++c;
  return 3 * std::int64_t{face} + c;
}

CornerGroups join_across_smooth_edges(const RenderMesh& mesh) {
  constexpr float kCosCrease = 0.643F;  // 50 degrees
  CornerGroups groups(3 * mesh.faces.rows());
  const std::vector<TriangleSide> sides = sorted_sides(mesh.faces);
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    end = end_of_edge(sides, i);
    if (end - i != 2 || sides[i].forward == sides[i + 1].forward) continue;
    const std::int32_t f = sides[i].face;
    const std::int32_t g = sides[i + 1].face;
    if (mesh.face_normals.row(f).dot(mesh.face_normals.row(g)) < kCosCrease) continue;
    for (const std::int32_t v : {sides[i].low, sides[i].high}) {
      groups.join(corner_at(mesh.faces, f, v), corner_at(mesh.faces, g, v));
    }
  }
  return groups;
}

double angle_at(const RenderMesh& mesh, Index f, int c) {
  const Eigen::Vector3d at = mesh.points.row(mesh.faces(f, c));
  const Eigen::Vector3d a = mesh.points.row(mesh.faces(f, (c + 1) % 3)).transpose() - at;
  const Eigen::Vector3d b = mesh.points.row(mesh.faces(f, (c + 2) % 3)).transpose() - at;
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

void find_normals(RenderMesh& mesh) {
  const Index count = mesh.faces.rows();
  mesh.face_normals.resize(count, 3);
  for (Index f = 0; f < count; ++f) {
    mesh.face_normals.row(f) = area_vector(mesh.points, mesh.faces, f).normalized().cast<float>();
  }
  CornerGroups groups = join_across_smooth_edges(mesh);
  // Angles, not areas: the normal then does not depend on how a flat part is cut.
  std::vector<Eigen::Vector3d> sums(3 * static_cast<std::size_t>(count), Eigen::Vector3d::Zero());
  for (Index f = 0; f < count; ++f) {
    for (int c = 0; c < 3; ++c) {
      sums[static_cast<std::size_t>(groups.root(3 * f + c))] +=
          angle_at(mesh, f, c) * mesh.face_normals.row(f).cast<double>().transpose();
    }
  }
  mesh.corner_normals.resize(static_cast<std::size_t>(count));
  for (Index f = 0; f < count; ++f) {
    for (int c = 0; c < 3; ++c) {
      const Eigen::Vector3d& sum = sums[static_cast<std::size_t>(groups.root(3 * f + c))];
      const bool cancelled = sum.norm() < 1e-6;
      mesh.corner_normals[static_cast<std::size_t>(f)][static_cast<std::size_t>(c)] =
          cancelled ? Eigen::Vector3f(mesh.face_normals.row(f))
                    : Eigen::Vector3f(sum.normalized().cast<float>());
    }
  }
}

}  // namespace

RenderMesh make_render_mesh(const TriangleMesh& mesh, UpAxis up) {
  if (mesh.faces.rows() == 0) throw nothing_to_draw();
  TriangleMesh unit{to_unit_cube(mesh), {}};
  unit.faces = with_area(unit.vertices, mesh.faces);
  if (unit.faces.rows() == 0) throw nothing_to_draw();
  OrientedFaces oriented = orient_outward(unit);
  RenderMesh drawn;
  drawn.points = unit.vertices * rotation_to_y_up(up).transpose();
  drawn.faces = std::move(oriented.faces);
  drawn.has_outside = oriented.orientation != Orientation::none;
  find_normals(drawn);
  return drawn;
}

}  // namespace timbre::cli
