#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"
#include "timbre/datasets/analytic.h"
#include "timbre/tests/support/mesh_shapes.h"

namespace timbre {

/// Edges split at a small share of their length: each makes two needles of about that angle, or
/// two triangles without area where the share is 0.
inline TriangleMesh with_cut_edges(const TriangleMesh& mesh, int cuts, double share,
                                   unsigned seed = 1) {
  struct Side {
    Eigen::Index face;
    int corner;
  };
  std::map<std::pair<std::int32_t, std::int32_t>, std::vector<Side>> edges;
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f) {
    for (int c = 0; c < 3; ++c) {
      edges[std::minmax<std::int32_t>(mesh.faces(f, c), mesh.faces(f, (c + 1) % 3))].push_back(
          {f, c});
    }
  }
  std::vector<std::pair<std::pair<std::int32_t, std::int32_t>, std::vector<Side>>> order(
      edges.begin(), edges.end());
  std::shuffle(order.begin(), order.end(), std::mt19937(seed));
  std::vector<std::array<std::int32_t, 3>> faces;
  for (const auto& row : mesh.faces.rowwise()) faces.push_back({row[0], row[1], row[2]});
  std::vector<std::array<double, 3>> vertices;
  for (const auto& row : mesh.vertices.rowwise()) vertices.push_back({row[0], row[1], row[2]});
  std::set<Eigen::Index> used;
  for (const auto& [edge, sides] : order) {
    if (cuts == 0) break;
    if (std::any_of(sides.begin(), sides.end(),
                    [&](const Side& side) { return used.contains(side.face); })) {
      continue;
    }
    --cuts;
    const auto middle = static_cast<std::int32_t>(vertices.size());
    const Eigen::RowVector3d point =
        (1.0 - share) * mesh.vertices.row(edge.first) + share * mesh.vertices.row(edge.second);
    vertices.push_back({point[0], point[1], point[2]});
    for (const Side& side : sides) {
      used.insert(side.face);
      auto& face = faces[static_cast<std::size_t>(side.face)];
      const auto corner = static_cast<std::size_t>(side.corner);
      const std::array<std::int32_t, 3> rest = {middle, face[(corner + 1) % 3],
                                                face[(corner + 2) % 3]};
      face[(corner + 1) % 3] = middle;
      faces.push_back(rest);
    }
  }
  return make_mesh(vertices, faces);
}

/// Rectangles [0, 1] x [0, 2] that meet at their side of length 2; `rows` of cells along it,
/// half as many across. With `obtuse`, three rows at a time make fans of obtuse triangles; `rows`
/// is then a multiple of 3.
inline TriangleMesh make_book(int pages, int rows, bool obtuse = false) {
  const int columns = rows / 2;
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::int32_t, 3>> faces;
  std::map<std::tuple<int, int, int>, std::int32_t> ids;
  for (int page = 0; page < pages; ++page) {
    const double turn = 2.0 * std::numbers::pi * page / pages;
    const auto id = [&](int i, int j) {
      const auto [at, is_new] =
          ids.try_emplace({i == 0 ? 0 : page, i, j}, static_cast<std::int32_t>(vertices.size()));
      const double x = double(i) / columns;
      if (is_new) vertices.push_back({x * std::cos(turn), x * std::sin(turn), 2.0 * j / rows});
      return at->second;
    };
    for (int i = 0; i < columns; ++i) {
      for (int j = 0; j < rows; j += obtuse ? 3 : 1) {
        if (obtuse) {
          for (int s = 0; s < 3; ++s) {
            faces.push_back({id(i, j + s), id(i + 1, j), id(i, j + s + 1)});
            faces.push_back({id(i, j + 3), id(i + 1, j + s), id(i + 1, j + s + 1)});
          }
        } else {
          faces.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
          faces.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
        }
      }
    }
  }
  return make_mesh(vertices, faces);
}

/// The lowest `count` Neumann eigenvalues of `make_book`: functions that are the same on all
/// pages, and those that are 0 at the spine.
inline Eigen::VectorXd book_spectrum(int pages, Eigen::Index count) {
  std::vector<double> values;
  for (int j = 0; j < 8; ++j) {
    for (int n = 0; n < 16; ++n) {
      const double along = n * std::numbers::pi / 2.0;
      const auto with = [&](double across) { return across * across + along * along; };
      values.push_back(with(j * std::numbers::pi));
      values.insert(values.end(), static_cast<std::size_t>(pages - 1),
                    with((j + 0.5) * std::numbers::pi));
    }
  }
  std::sort(values.begin(), values.end());
  return Eigen::Map<const Eigen::VectorXd>(values.data(), count);
}

/// A flat band of length 3 and width 1 with half a twist, by lengths: no fold in space.
inline IntrinsicMesh make_flat_moebius_strip(int columns, int rows) {
  const double across = 1.0 / rows;
  const double along = 3.0 / columns;
  const double diagonal = std::hypot(across, along);
  const auto id = [&](int i, int j) {
    return i % columns * (rows + 1) + (i < columns ? j : rows - j);
  };
  IntrinsicMesh strip;
  strip.vertices = static_cast<Eigen::Index>(columns) * (rows + 1);
  strip.faces.resize(2 * columns * rows, 3);
  strip.lengths.resize(2 * columns * rows, 3);
  Eigen::Index f = 0;
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) {
      strip.faces.row(f) << id(i, j), id(i + 1, j), id(i + 1, j + 1);
      strip.lengths.row(f++) << across, diagonal, along;
      strip.faces.row(f) << id(i, j), id(i + 1, j + 1), id(i, j + 1);
      strip.lengths.row(f++) << along, across, diagonal;
    }
  }
  return strip;
}

/// Its lowest Neumann eigenvalues: functions even across go with even waves along.
inline Eigen::VectorXd moebius_spectrum(Eigen::Index count) {
  std::vector<double> values;
  for (int n = 0; n < 12; ++n) {
    for (int m = n % 2; m < 40; m += 2) {
      const double value =
          std::pow(n * std::numbers::pi, 2) + std::pow(m * std::numbers::pi / 3, 2);
      values.insert(values.end(), m == 0 ? 1 : 2, value);
    }
  }
  std::sort(values.begin(), values.end());
  return Eigen::Map<const Eigen::VectorXd>(values.data(), count);
}

/// What points a soup of triangles has.
enum class SoupKind : std::uint8_t { generic, lattice, flat, line, spread, rounded };

/// Random triangles on random points, all sharing edges and vertices with many others; those on
/// the lattice of 27 points coincide, some have a repeated corner.
inline TriangleMesh make_soup(SoupKind kind, unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
  };
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const int n = between(3, 59);
  TriangleMesh mesh;
  mesh.vertices.resize(n, 3);
  for (double& x : mesh.vertices.reshaped()) x = uniform(random);
  for (auto row : mesh.vertices.rowwise()) {
    if (kind == SoupKind::lattice) row = (3.0 * row.array()).floor();
    if (kind == SoupKind::flat) row[2] = 0.0;
    if (kind == SoupKind::line) row.tail(2) *= 1e-9;
    if (kind == SoupKind::spread) row *= std::pow(10.0, -6.0 * uniform(random));
    if (kind == SoupKind::rounded) row = (10.0 * row.array()).round() / 10.0;
  }
  mesh.faces.resize(between(1, 149), 3);
  for (auto face : mesh.faces.rowwise()) {
    do {
      for (std::int32_t& corner : face) corner = between(0, n - 1);
    } while (kind != SoupKind::lattice &&
             (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]));
  }
  return mesh;
}

}  // namespace timbre
