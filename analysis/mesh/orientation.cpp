#include "timbre/analysis/mesh/orientation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "timbre/analysis/mesh/sides.h"

namespace timbre {
namespace {

using Eigen::Index;

struct Neighbour {
  std::int32_t face = 0;
  bool must_differ = false;  ///< both run along the edge the same way: one must turn
};

struct Adjacency {
  std::vector<std::vector<Neighbour>> of_face;  ///< across edges of exactly two triangles
  double open_share = 0.0;                      ///< of the edges: not of two triangles
};

Adjacency adjacency_of(const Faces& faces) {
  const std::vector<TriangleSide> sides = sorted_sides(faces);
  Adjacency adjacency;
  adjacency.of_face.resize(static_cast<std::size_t>(faces.rows()));
  double edges = 0.0;
  double open = 0.0;
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    end = end_of_edge(sides, begin);
    edges += 1.0;
    if (end - begin != 2) {
      open += 1.0;
      continue;
    }
    const TriangleSide& a = sides[begin];
    const TriangleSide& b = sides[begin + 1];
    const bool differ = a.forward == b.forward;
    adjacency.of_face[static_cast<std::size_t>(a.face)].push_back({b.face, differ});
    adjacency.of_face[static_cast<std::size_t>(b.face)].push_back({a.face, differ});
  }
  adjacency.open_share = edges > 0.0 ? open / edges : 1.0;
  return adjacency;
}

struct Winding {
  std::vector<bool> turn;           ///< which faces to turn
  std::vector<std::int32_t> patch;  ///< faces joined by edges of two triangles
  std::int32_t patches = 0;
  bool one_sided = false;
};

Winding wind(const Adjacency& adjacency) {
  const std::size_t count = adjacency.of_face.size();
  Winding winding{std::vector<bool>(count, false), std::vector<std::int32_t>(count, -1)};
  std::vector<std::size_t> queue;
  for (std::size_t start = 0; start < count; ++start) {
    if (winding.patch[start] >= 0) continue;
    winding.patch[start] = winding.patches;
    queue.assign(1, start);
    while (!queue.empty()) {
      const std::size_t f = queue.back();
      queue.pop_back();
      for (const Neighbour& next : adjacency.of_face[f]) {
        const auto g = static_cast<std::size_t>(next.face);
        const bool wanted = winding.turn[f] != next.must_differ;
        if (winding.patch[g] >= 0) {
          winding.one_sided = winding.one_sided || winding.turn[g] != wanted;
          continue;
        }
        winding.patch[g] = winding.patches;
        winding.turn[g] = wanted;
        queue.push_back(g);
      }
    }
    ++winding.patches;
  }
  return winding;
}

// Patches in which most faces would turn: there the file's side is the other one.
std::vector<bool> patches_turned_mostly(const Winding& winding) {
  std::vector<std::int64_t> balance(static_cast<std::size_t>(winding.patches), 0);
  for (std::size_t f = 0; f < winding.turn.size(); ++f) {
    balance[static_cast<std::size_t>(winding.patch[f])] += winding.turn[f] ? 1 : -1;
  }
  std::vector<bool> mostly(balance.size());
  std::transform(balance.begin(), balance.end(), mostly.begin(),
                 [](std::int64_t sum) { return sum > 0; });
  return mostly;
}

struct Extent {
  std::vector<double> volume;  ///< of each patch, seen from the middle of the mesh
  double area = 0.0;
};

Extent measure(const Points& points, const Faces& faces, const Winding& winding) {
  // From the middle, not the origin: far away the sum would be rounding alone.
  const Eigen::RowVector3d middle =
      0.5 * (points.colwise().minCoeff() + points.colwise().maxCoeff());
  Extent extent{std::vector<double>(static_cast<std::size_t>(winding.patches), 0.0)};
  for (Index f = 0; f < faces.rows(); ++f) {
    const Eigen::RowVector3d a = points.row(faces(f, 0)) - middle;
    const Eigen::RowVector3d b = points.row(faces(f, 1)) - middle;
    const Eigen::RowVector3d c = points.row(faces(f, 2)) - middle;
    const auto patch = static_cast<std::size_t>(winding.patch[static_cast<std::size_t>(f)]);
    extent.volume[patch] += a.cross(b).dot(c) / 6.0;
    extent.area += 0.5 * (b - a).cross(c - a).norm();
  }
  return extent;
}

}  // namespace

OrientedFaces orient_outward(const TriangleMesh& mesh) {
  OrientedFaces result{mesh.faces, Orientation::none};
  const Adjacency adjacency = adjacency_of(mesh.faces);
  const Winding winding = wind(adjacency);
  if (winding.one_sided || mesh.faces.rows() == 0) return result;
  const std::vector<bool> against_most = patches_turned_mostly(winding);
  for (Index f = 0; f < mesh.faces.rows(); ++f) {
    const auto at = static_cast<std::size_t>(f);
    const bool turned_mostly = against_most[static_cast<std::size_t>(winding.patch[at])];
    if (winding.turn[at] != turned_mostly) std::swap(result.faces(f, 1), result.faces(f, 2));
  }
  const Extent extent = measure(mesh.vertices, result.faces, winding);
  const double rounding = 1e-9 * std::pow(extent.area, 1.5);
  double volume = 0.0;
  for (const double part : extent.volume) volume += std::abs(part);
  constexpr double kMostOpen = 0.02;
  constexpr double kLeastVolume = 1e-3;  // of area^1.5; a ball has 0.094
  const bool has_inside =
      adjacency.open_share <= kMostOpen && volume > kLeastVolume * std::pow(extent.area, 1.5);
  result.orientation = has_inside ? Orientation::outward : Orientation::consistent;
  if (!has_inside) return result;
  for (Index f = 0; f < mesh.faces.rows(); ++f) {
    const auto patch = static_cast<std::size_t>(winding.patch[static_cast<std::size_t>(f)]);
    if (extent.volume[patch] < -rounding) std::swap(result.faces(f, 1), result.faces(f, 2));
  }
  return result;
}

}  // namespace timbre
