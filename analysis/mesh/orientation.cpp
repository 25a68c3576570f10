#include "timbre/analysis/mesh/orientation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <tuple>
#include <utility>
#include <vector>

namespace timbre {
namespace {

using Eigen::Index;

// A side of a triangle; `forward`: it runs from the smaller vertex to the larger.
struct Side {
  std::int32_t low = 0;
  std::int32_t high = 0;
  std::int32_t face = 0;
  bool forward = false;
};

bool is_surface_face(const Faces& faces, Index f) {
  return faces(f, 0) != faces(f, 1) && faces(f, 1) != faces(f, 2) && faces(f, 2) != faces(f, 0);
}

std::vector<Side> sorted_sides(const Faces& faces) {
  std::vector<Side> sides;
  sides.reserve(static_cast<std::size_t>(3 * faces.rows()));
  for (Index f = 0; f < faces.rows(); ++f) {
    if (!is_surface_face(faces, f)) continue;
    for (int c = 0; c < 3; ++c) {
      const std::int32_t a = faces(f, c);
      const std::int32_t b = faces(f, (c + 1) % 3);
      sides.push_back({std::min(a, b), std::max(a, b), static_cast<std::int32_t>(f), a < b});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tuple(a.low, a.high, a.face) < std::tuple(b.low, b.high, b.face);
  });
  return sides;
}

struct Neighbour {
  std::int32_t face = 0;
  bool must_differ = false;  ///< both run along the edge the same way: one must turn
};

// Empty unless each edge has exactly two faces.
std::vector<std::vector<Neighbour>> closed_manifold_neighbours(const Faces& faces) {
  const std::vector<Side> sides = sorted_sides(faces);
  std::vector<std::vector<Neighbour>> neighbours(static_cast<std::size_t>(faces.rows()));
  for (std::size_t i = 0; i < sides.size(); i += 2) {
    const auto same_edge = [&](std::size_t j) {
      return j < sides.size() && sides[j].low == sides[i].low && sides[j].high == sides[i].high;
    };
    if (!same_edge(i + 1) || same_edge(i + 2)) return {};
    const Side& a = sides[i];
    const Side& b = sides[i + 1];
    const bool differ = a.forward == b.forward;
    neighbours[static_cast<std::size_t>(a.face)].push_back({b.face, differ});
    neighbours[static_cast<std::size_t>(b.face)].push_back({a.face, differ});
  }
  return neighbours;
}

// Which faces to turn; empty for a one-sided surface.
std::vector<bool> faces_to_turn(const std::vector<std::vector<Neighbour>>& neighbours) {
  std::vector<bool> turn(neighbours.size(), false);
  std::vector<bool> seen(neighbours.size(), false);
  std::vector<std::size_t> queue;
  for (std::size_t start = 0; start < neighbours.size(); ++start) {
    if (seen[start]) continue;
    seen[start] = true;
    queue.assign(1, start);
    while (!queue.empty()) {
      const std::size_t f = queue.back();
      queue.pop_back();
      for (const Neighbour& next : neighbours[f]) {
        const auto g = static_cast<std::size_t>(next.face);
        const bool wanted = turn[f] != next.must_differ;
        if (seen[g] && turn[g] != wanted) return {};
        if (seen[g]) continue;
        seen[g] = true;
        turn[g] = wanted;
        queue.push_back(g);
      }
    }
  }
  return turn;
}

double signed_volume(const Points& points, const Faces& faces) {
  double six = 0.0;
  for (Index f = 0; f < faces.rows(); ++f) {
    const Eigen::RowVector3d a = points.row(faces(f, 0));
    const Eigen::RowVector3d b = points.row(faces(f, 1));
    six += a.cross(b).dot(points.row(faces(f, 2)));
  }
  return six / 6.0;
}

}  // namespace

OrientedFaces orient_outward(const TriangleMesh& mesh) {
  OrientedFaces result{mesh.faces, Orientation::unknown};
  const auto neighbours = closed_manifold_neighbours(mesh.faces);
  if (neighbours.empty()) return result;
  const std::vector<bool> turn = faces_to_turn(neighbours);
  if (turn.empty()) return result;
  Faces faces = mesh.faces;
  for (Index f = 0; f < faces.rows(); ++f) {
    if (turn[static_cast<std::size_t>(f)]) std::swap(faces(f, 1), faces(f, 2));
  }
  if (signed_volume(mesh.vertices, faces) < 0.0) faces.col(1).swap(faces.col(2));
  result.faces = std::move(faces);
  result.orientation = Orientation::outward;
  return result;
}

}  // namespace timbre
