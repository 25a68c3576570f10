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

// The same triangles between the first vertices at each position: files often have a vertex
// for each triangle or patch, and seams should not show.
Faces welded(const Points& points, const Faces& faces) {
  const auto n = static_cast<std::size_t>(points.rows());
  std::vector<std::int32_t> order(n);
  std::iota(order.begin(), order.end(), 0);
  const auto place = [&](std::int32_t v) {
    return std::array{points(v, 0), points(v, 1), points(v, 2)};
  };
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return place(a) != place(b) ? place(a) < place(b) : a < b;
  });
  std::vector<std::int32_t> first(n);
  for (std::size_t i = 0; i < n; ++i) {
    const bool same = i > 0 && place(order[i]) == place(order[i - 1]);
    first[static_cast<std::size_t>(order[i])] =
        same ? first[static_cast<std::size_t>(order[i - 1])] : order[i];
  }
  return faces.unaryExpr([&](std::int32_t v) { return first[static_cast<std::size_t>(v)]; });
}

// Keeps the first of triangles with the same corners. Returns which of those that are kept
// stand for several: rounding would decide which of them the eye sees.
std::vector<bool> drop_repeated(Faces& faces, Faces& joined) {
  const auto count = static_cast<std::size_t>(faces.rows());
  using Key = std::array<std::int32_t, 4>;  // sorted corners, number
  std::vector<Key> keys(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto f = static_cast<Index>(i);
    keys[i] = {joined(f, 0), joined(f, 1), joined(f, 2), static_cast<std::int32_t>(i)};
    std::sort(keys[i].begin(), keys[i].begin() + 3);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<bool> dropped(count);
  std::vector<bool> repeated(count);
  for (std::size_t i = 1, first = 0; i < count; ++i) {
    if (!std::equal(keys[i].begin(), keys[i].begin() + 3, keys[first].begin())) {
      first = i;
      continue;
    }
    dropped[static_cast<std::size_t>(keys[i][3])] = true;
    repeated[static_cast<std::size_t>(keys[first][3])] = true;
  }
  Index kept = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (dropped[i]) continue;
    faces.row(kept) = faces.row(static_cast<Index>(i));
    joined.row(kept) = joined.row(static_cast<Index>(i));
    repeated[static_cast<std::size_t>(kept++)] = repeated[i];
  }
  faces.conservativeResize(kept, 3);
  joined.conservativeResize(kept, 3);
  repeated.resize(static_cast<std::size_t>(kept));
  return repeated;
}

// Six times the volume under the triangles, as seen from the middle of their corners.
double signed_volume(const Points& points, const Faces& faces) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const std::int32_t v : faces.reshaped()) middle += points.row(v).transpose();
  middle /= static_cast<double>(faces.size());
  double sum = 0.0;
  for (Index f = 0; f < faces.rows(); ++f) {
    sum += area_vector(points, faces, f).dot(points.row(faces(f, 0)).transpose() - middle);
  }
  return sum;
}

// Turns triangles outward, or, where the surface is too open to tell, so that it is rather
// full than hollow. Returns whether neighbours agree.
bool turn_outward(const Points& points, Faces& faces, Faces& joined) {
  const OrientedFaces oriented = orient_outward({points, joined});
  for (Index f = 0; f < faces.rows(); ++f) {
    if (oriented.faces.row(f) != joined.row(f)) std::swap(faces(f, 1), faces(f, 2));
  }
  if (oriented.orientation == Orientation::consistent && signed_volume(points, faces) < -1e-3) {
    faces.col(1).swap(faces.col(2));
  }
  joined = welded(points, faces);
  return oriented.orientation != Orientation::none;
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

CornerGroups join_across_smooth_edges(const RenderMesh& mesh, const Faces& joined) {
  constexpr float kCosCrease = 0.643F;  // 50 degrees
  CornerGroups groups(3 * mesh.faces.rows());
  const std::vector<TriangleSide> sides = sorted_sides(joined);
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    end = end_of_edge(sides, i);
    if (end - i != 2 || sides[i].forward == sides[i + 1].forward) continue;
    const std::int32_t f = sides[i].face;
    const std::int32_t g = sides[i + 1].face;
    if (mesh.face_normals.row(f).dot(mesh.face_normals.row(g)) < kCosCrease) continue;
    for (const std::int32_t v : {sides[i].low, sides[i].high}) {
      groups.join(corner_at(joined, f, v), corner_at(joined, g, v));
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

void find_normals(RenderMesh& mesh, const Faces& joined) {
  const Index count = mesh.faces.rows();
  mesh.face_normals.resize(count, 3);
  for (Index f = 0; f < count; ++f) {
    mesh.face_normals.row(f) = area_vector(mesh.points, mesh.faces, f).normalized().cast<float>();
  }
  CornerGroups groups = join_across_smooth_edges(mesh, joined);
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
  const Points unit = to_unit_cube(mesh);
  RenderMesh drawn;
  drawn.faces = with_area(unit, mesh.faces);
  if (drawn.faces.rows() == 0) throw nothing_to_draw();
  Faces joined = welded(unit, drawn.faces);
  drawn.has_back = drop_repeated(drawn.faces, joined);
  drawn.has_back.flip();
  if (!turn_outward(unit, drawn.faces, joined)) drawn.has_back.assign(drawn.has_back.size(), false);
  drawn.points = unit * rotation_to_y_up(up).transpose();
  find_normals(drawn, joined);
  return drawn;
}

}  // namespace timbre::cli
