#include "timbre/datasets/detail/half_surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>
#include <utility>

namespace timbre::detail {
namespace {

using Eigen::Vector3d;

std::uint64_t edge_key(std::int32_t a, std::int32_t b) {
  const auto [low, high] = std::minmax(a, b);
  return (static_cast<std::uint64_t>(low) << 32) | static_cast<std::uint32_t>(high);
}

struct Side {
  std::size_t face = 0;
  std::size_t corner = 0;  // opposite the edge
};
using Edges = std::unordered_map<std::uint64_t, std::vector<Side>>;

Edges edges_of(const std::vector<Triangle>& faces) {
  Edges edges;
  edges.reserve(2 * faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      edges[edge_key(faces[f][(c + 1) % 3], faces[f][(c + 2) % 3])].push_back({f, c});
    }
  }
  return edges;
}

double angle_at(const HalfSurface& surface, const Side& side) {
  const Triangle& face = surface.faces[side.face];
  const auto at = [&](std::size_t c) -> const Vector3d& {
    return surface.points[static_cast<std::size_t>(face[(side.corner + c) % 3])];
  };
  const Vector3d p = at(1) - at(0);
  const Vector3d q = at(2) - at(0);
  return std::atan2(p.cross(q).norm(), p.dot(q));
}

// Makes edges Delaunay, each face changed at most once. An edge between two points of the
// plane would meet its own mirror image, so none is made.
void flip_edges(HalfSurface& surface) {
  const Edges edges = edges_of(surface.faces);
  std::vector<bool> changed(surface.faces.size(), false);
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    for (std::size_t c = 0; c < 3 && !changed[f]; ++c) {
      const Triangle face = surface.faces[f];
      const std::int32_t a = face[(c + 1) % 3];
      const std::int32_t b = face[(c + 2) % 3];
      const std::vector<Side>& sides = edges.at(edge_key(a, b));
      if (sides.size() != 2 || sides[0].face != f || changed[sides[1].face]) continue;
      const Side& other = sides[1];
      const std::int32_t left = face[c];
      const std::int32_t right = surface.faces[other.face][other.corner];
      if (surface.in_plane(left) && surface.in_plane(right)) continue;
      if (edges.contains(edge_key(left, right))) continue;
      if (angle_at(surface, sides[0]) + angle_at(surface, other) < std::numbers::pi + 1e-6)
        continue;
      surface.faces[f] = {left, a, right};
      surface.faces[other.face] = {right, b, left};
      changed[f] = changed[other.face] = true;
    }
  }
}

// The mean of the neighbours in the whole surface. Summed over faces each neighbour counts
// twice, but once along the border: the other face of such an edge is the mirror image.
std::vector<Vector3d> neighbour_means(const HalfSurface& surface) {
  std::vector<Vector3d> sum(surface.points.size(), Vector3d::Zero());
  std::vector<double> count(surface.points.size(), 0.0);
  for (const Triangle& face : surface.faces) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto to = static_cast<std::size_t>(face[c]);
      for (const std::int32_t from : {face[(c + 1) % 3], face[(c + 2) % 3]}) {
        sum[to] += surface.points[static_cast<std::size_t>(from)];
        count[to] += 1.0;
      }
    }
  }
  for (std::size_t v = 0; v < sum.size(); ++v) {
    sum[v] /= count[v];
    if (surface.in_plane(static_cast<std::int32_t>(v))) sum[v].x() = 0.0;
  }
  return sum;
}

}  // namespace

double distance_estimate(const ImplicitValue& value) {
  return value.value / std::max(value.gradient.norm(), 0.1);
}

Vector3d project(const ImplicitFunction& f, const Vector3d& point) {
  Vector3d p = point;
  for (int step = 0; step < 4; ++step) {
    ImplicitValue here = f(p);
    if (point.x() == 0.0) here.gradient.x() = 0.0;
    // Where bodies meet the gradient shrinks; a bounded divisor keeps the step short.
    p -= here.value / std::max(here.gradient.squaredNorm(), 0.25) * here.gradient;
  }
  return p;
}

void relax(HalfSurface& surface, const ImplicitFunction& f, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    flip_edges(surface);
    const std::vector<Vector3d> means = neighbour_means(surface);
    for (std::size_t v = 0; v < surface.points.size(); ++v) {
      Vector3d& point = surface.points[v];
      // Along the surface only: at the tip of a thin limb the mean lies deep inside.
      const Vector3d normal = f(point).gradient.normalized();
      const Vector3d move = means[v] - point;
      point = project(f, point + move - move.dot(normal) * normal);
    }
  }
}

}  // namespace timbre::detail
