#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"
#include "timbre/datasets/analytic.h"

namespace timbre {

/// A lumpy body without any symmetry.
inline TriangleMesh make_lump(int frequency) {
  TriangleMesh mesh = make_sphere(frequency);
  for (auto row : mesh.vertices.rowwise()) {
    const double x = row[0];
    const double y = row[1];
    const double z = row[2];
    row *= 1.0 + 0.35 * z + 0.3 * std::exp(-4.0 * ((x - 0.8) * (x - 0.8) + (y - 0.5) * (y - 0.5))) +
           0.15 * x * y - 0.2 * y * z + 0.1 * std::sin(3.0 * x + y);
    row[1] *= 1.4;
    row[2] *= 1.9;
  }
  return mesh;
}

/// The same, but equal to its mirror image x -> -x.
inline TriangleMesh make_mirrored_lump(int frequency) {
  TriangleMesh mesh = make_sphere(frequency);
  for (auto row : mesh.vertices.rowwise()) {
    const double x = row[0] * row[0];
    const double y = row[1];
    const double z = row[2];
    const double arms = std::exp(-5.0 * ((x - 0.6) * (x - 0.6) + (y - 0.5) * (y - 0.5)));
    const double nose = std::exp(-5.0 * ((z - 0.9) * (z - 0.9) + (y - 0.2) * (y - 0.2)));
    row *= 1.0 + 0.7 * arms + 0.5 * nose - 0.3 * y * z + 0.1 * std::sin(3.0 * z + y);
    row[1] *= 1.6;
    row[2] *= 1.2;
  }
  return mesh;
}

/// The same surface with its vertices renumbered: vertex i becomes `order[i]`.
inline TriangleMesh renumbered(const TriangleMesh& mesh, const std::vector<std::int32_t>& order) {
  TriangleMesh result = mesh;
  for (std::size_t i = 0; i < order.size(); ++i) {
    result.vertices.row(order[i]) = mesh.vertices.row(static_cast<Eigen::Index>(i));
  }
  for (std::int32_t& corner : result.faces.reshaped()) {
    corner = order[static_cast<std::size_t>(corner)];
  }
  return result;
}

inline std::vector<std::int32_t> random_order(Eigen::Index n, unsigned seed) {
  std::vector<std::int32_t> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(seed));
  return order;
}

/// The same faces in another order, half of them turned over.
inline TriangleMesh with_faces_shuffled(const TriangleMesh& mesh, unsigned seed) {
  const std::vector<std::int32_t> order = random_order(mesh.faces.rows(), seed);
  std::mt19937 random(seed);
  TriangleMesh result = mesh;
  for (std::size_t f = 0; f < order.size(); ++f) {
    auto face = result.faces.row(static_cast<Eigen::Index>(f));
    face = mesh.faces.row(order[f]);
    if (random() % 2 == 0) std::swap(face[1], face[2]);
  }
  return result;
}

}  // namespace timbre
