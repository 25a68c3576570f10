#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "timbre/datasets/creatures.h"
#include "timbre/datasets/detail/creature_checks.h"
#include "timbre/datasets/detail/nearest_points.h"
#include "timbre/datasets/isosurface.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::RowVector3d;

// A random turn, uniform over all of them.
// @see Shoemake 1992
Eigen::Quaterniond random_turn(Random& random) {
  const double u = random.uniform(0.0, 1.0);
  const double a = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double b = random.uniform(0.0, 2.0 * std::numbers::pi);
  return {std::sqrt(u) * std::cos(b), std::sqrt(1.0 - u) * std::sin(a),
          std::sqrt(1.0 - u) * std::cos(a), std::sqrt(u) * std::sin(b)};
}

// The triangles around each vertex.
std::vector<std::vector<Index>> fans(const TriangleMesh& mesh) {
  std::vector<std::vector<Index>> fan(static_cast<std::size_t>(mesh.vertices.rows()));
  for (Index f = 0; f < mesh.faces.rows(); ++f) {
    for (Index c = 0; c < 3; ++c) fan[static_cast<std::size_t>(mesh.faces(f, c))].push_back(f);
  }
  return fan;
}

// Barycentric coordinates of the foot of `p` on a triangle's plane, drawn back to the
// triangle where they leave it.
RowVector3d foot(const TriangleMesh& mesh, Index face, const RowVector3d& p) {
  const RowVector3d a = mesh.vertices.row(mesh.faces(face, 0));
  const RowVector3d u = mesh.vertices.row(mesh.faces(face, 1)) - a;
  const RowVector3d v = mesh.vertices.row(mesh.faces(face, 2)) - a;
  Eigen::Matrix2d gram;
  gram << u.dot(u), u.dot(v), u.dot(v), v.dot(v);
  const Eigen::Vector2d st = gram.inverse() * Eigen::Vector2d(u.dot(p - a), v.dot(p - a));
  RowVector3d weights = RowVector3d(1.0 - st.sum(), st[0], st[1]).cwiseMax(0.0);
  return weights / weights.sum();
}

// The weights of the template, read off where the template's triangles are nearest.
Eigen::MatrixXd carried_weights(const Points& points, const CreatureSkin& from) {
  const std::vector<std::int32_t> start = detail::nearest_points(points, from.rest.vertices);
  const std::vector<std::vector<Index>> fan = fans(from.rest);
  Eigen::MatrixXd weights(points.rows(), from.weights.cols());
  for (Index v = 0; v < points.rows(); ++v) {
    double least = std::numeric_limits<double>::infinity();
    const auto first = static_cast<std::size_t>(start[static_cast<std::size_t>(v)]);
    for (const Index f : fan[first]) {
      const RowVector3d bary = foot(from.rest, f, points.row(v));
      const Eigen::RowVector3i corner = from.rest.faces.row(f);
      const RowVector3d at = bary[0] * from.rest.vertices.row(corner[0]) +
                             bary[1] * from.rest.vertices.row(corner[1]) +
                             bary[2] * from.rest.vertices.row(corner[2]);
      const double distance = (points.row(v) - at).squaredNorm();
      if (distance >= least) continue;
      least = distance;
      weights.row(v) = bary[0] * from.weights.row(corner[0]) +
                       bary[1] * from.weights.row(corner[1]) +
                       bary[2] * from.weights.row(corner[2]);
    }
  }
  return weights;
}

}  // namespace

CreatureSkin retessellate(const CreatureBody& body, int vertices, Random& random) {
  detail::require_possible_count(vertices);
  constexpr int kAttempts = 6;  // a lattice may meet a thin part badly, another will not
  const auto usual = static_cast<double>(body.skin.rest.vertices.rows());
  const double cell = body.cell * std::sqrt(usual / vertices);
  CreatureSkin skin;
  for (int attempt = 0; attempt < kAttempts && skin.mirror.empty(); ++attempt) {
    skin.rest = make_isosurface(skin_of(body.skeleton), bounds_of(body.skeleton), cell,
                                random_turn(random));
    if (detail::is_sphere(skin.rest)) {
      Points image = skin.rest.vertices;
      image.col(0) *= -1.0;
      skin.mirror = detail::nearest_points(image, skin.rest.vertices);
    }
  }
  if (skin.mirror.empty()) detail::refuse_count(vertices, body.species);
  skin.weights = carried_weights(skin.rest.vertices, body.skin);
  skin.vertex_of_template = detail::nearest_points(body.skin.rest.vertices, skin.rest.vertices);
  return skin;
}

}  // namespace timbre
