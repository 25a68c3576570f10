#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre {

inline TriangleMesh make_mesh(const std::vector<std::array<double, 3>>& vertices,
                              const std::vector<std::array<std::int32_t, 3>>& faces) {
  TriangleMesh mesh;
  mesh.vertices.resize(std::ssize(vertices), 3);
  mesh.faces.resize(std::ssize(faces), 3);
  for (Eigen::Index i = 0; i < mesh.vertices.rows(); ++i) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      mesh.vertices(i, k) = vertices[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
    }
  }
  for (Eigen::Index i = 0; i < mesh.faces.rows(); ++i) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      mesh.faces(i, k) = faces[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
    }
  }
  return mesh;
}

/// The corner of the unit cube: volume 1/6, area 3/2 + sqrt(3)/2.
inline TriangleMesh tetrahedron() {
  return make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                   {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
}

/// Eight equilateral triangles.
inline TriangleMesh octahedron() {
  return make_mesh(
      {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}});
}

/// (n + 1)^2 points of the unit square, row by row, and 2 n^2 triangles.
inline TriangleMesh grid(std::int32_t n) {
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::int32_t, 3>> faces;
  for (std::int32_t j = 0; j <= n; ++j) {
    for (std::int32_t i = 0; i <= n; ++i) vertices.push_back({double(i) / n, double(j) / n, 0.0});
  }
  for (std::int32_t j = 0; j < n; ++j) {
    for (std::int32_t i = 0; i < n; ++i) {
      const std::int32_t a = j * (n + 1) + i;
      faces.push_back({a, a + 1, a + n + 2});
      faces.push_back({a, a + n + 2, a + n + 1});
    }
  }
  return make_mesh(vertices, faces);
}

/// m x n vertices round a torus of radii 2 and 1.
inline TriangleMesh torus(std::int32_t m, std::int32_t n) {
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::int32_t, 3>> faces;
  const double turn = 2.0 * std::numbers::pi;
  for (std::int32_t i = 0; i < m; ++i) {
    for (std::int32_t j = 0; j < n; ++j) {
      const double u = turn * i / m;
      const double v = turn * j / n;
      const double r = 2.0 + std::cos(v);
      vertices.push_back({r * std::cos(u), r * std::sin(u), std::sin(v)});
      const auto at = [m, n](std::int32_t p, std::int32_t q) { return p % m * n + q % n; };
      faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return make_mesh(vertices, faces);
}

/// A band of n quads with half a twist.
inline TriangleMesh moebius_strip(std::int32_t n) {
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::int32_t, 3>> faces;
  for (std::int32_t i = 0; i < n; ++i) {
    const double u = 2.0 * std::numbers::pi * i / n;
    for (const double w : {-0.5, 0.5}) {
      const double r = 2.0 + w * std::cos(u / 2);
      vertices.push_back({r * std::cos(u), r * std::sin(u), w * std::sin(u / 2)});
    }
    const std::int32_t a = 2 * i;
    const std::int32_t b = a + 1;
    const std::int32_t c = i + 1 < n ? a + 2 : 1;  // the two sides change places
    const std::int32_t d = i + 1 < n ? a + 3 : 0;
    faces.push_back({a, c, d});
    faces.push_back({a, d, b});
  }
  return make_mesh(vertices, faces);
}

/// An icosahedron on the unit sphere, each triangle split into four `levels` times.
inline TriangleMesh sphere(int levels) {
  const double t = std::numbers::phi;
  std::vector<std::array<double, 3>> vertices = {{-1, t, 0}, {1, t, 0}, {-1, -t, 0}, {1, -t, 0},
                                                 {0, -1, t}, {0, 1, t}, {0, -1, -t}, {0, 1, -t},
                                                 {t, 0, -1}, {t, 0, 1}, {-t, 0, -1}, {-t, 0, 1}};
  std::vector<std::array<std::int32_t, 3>> faces = {
      {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
    const auto middle = [&](std::int32_t a, std::int32_t b) {
      const auto [at, is_new] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::int32_t>(vertices.size()));
      if (is_new) {
        const auto& p = vertices[static_cast<std::size_t>(a)];
        const auto& q = vertices[static_cast<std::size_t>(b)];
        vertices.push_back({p[0] + q[0], p[1] + q[1], p[2] + q[2]});
      }
      return at->second;
    };
    std::vector<std::array<std::int32_t, 3>> finer;
    for (const auto& [a, b, c] : faces) {
      const std::int32_t ab = middle(a, b);
      const std::int32_t bc = middle(b, c);
      const std::int32_t ca = middle(c, a);
      for (const auto& face : {std::array{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}}) {
        finer.push_back(face);
      }
    }
    faces = std::move(finer);
    for (auto& [x, y, z] : vertices) {
      const double length = std::hypot(x, y, z);
      x /= length;
      y /= length;
      z /= length;
    }
  }
  for (auto& [x, y, z] : vertices) {
    const double length = std::hypot(x, y, z);
    x /= length;
    y /= length;
    z /= length;
  }
  return make_mesh(vertices, faces);
}

/// Several meshes as one, in the order given.
inline TriangleMesh joined(const std::vector<TriangleMesh>& parts) {
  TriangleMesh all;
  for (const TriangleMesh& part : parts) {
    const Eigen::Index n = all.vertices.rows();
    const Eigen::Index m = all.faces.rows();
    all.vertices.conservativeResize(n + part.vertices.rows(), 3);
    all.faces.conservativeResize(m + part.faces.rows(), 3);
    all.vertices.bottomRows(part.vertices.rows()) = part.vertices;
    all.faces.bottomRows(part.faces.rows()) = part.faces.array() + static_cast<std::int32_t>(n);
  }
  return all;
}

/// Twice the area, summed over the triangles; signed along z.
inline double twice_signed_area_z(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f) {
    const auto a = mesh.vertices.row(mesh.faces(f, 0));
    const auto b = mesh.vertices.row(mesh.faces(f, 1));
    const auto c = mesh.vertices.row(mesh.faces(f, 2));
    sum += (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  }
  return sum;
}

}  // namespace timbre
