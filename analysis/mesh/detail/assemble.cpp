#include "timbre/analysis/mesh/detail/assemble.h"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

#include "timbre/analysis/mesh/detail/grouping.h"
#include "timbre/analysis/mesh/detail/triangulate.h"
#include "timbre/analysis/mesh/triangle.h"

namespace timbre::detail {
namespace {

constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();

using Polygon = std::span<const std::int32_t>;
using Triangle = std::span<const std::int32_t, 3>;

// Polygons of less than three corners make no triangle and are passed over.
template <typename Visit>
void for_each_polygon(const PolygonMesh& mesh, Visit visit) {
  for (std::size_t i = 0; i < mesh.polygon_count(); ++i) {
    const Polygon polygon = mesh.polygon(i);
    if (polygon.size() >= 3) visit(polygon, static_cast<std::int64_t>(i));
  }
}

void find_dropped_elements(PolygonMesh& mesh) {
  if (mesh.has_only_triangles()) return;
  for (std::size_t i = 0; i < mesh.polygon_count(); ++i) {
    if (mesh.polygon(i).size() >= 3) continue;
    mesh.findings.add(Finding::dropped_element, static_cast<std::int64_t>(i));
  }
}

std::vector<std::int32_t> sorted(Polygon polygon) {
  std::vector<std::int32_t> corners(polygon.begin(), polygon.end());
  std::sort(corners.begin(), corners.end());
  return corners;
}

bool repeats_a_corner(Polygon polygon) {
  if (polygon.size() == 3) {
    return polygon[0] == polygon[1] || polygon[1] == polygon[2] || polygon[2] == polygon[0];
  }
  const std::vector<std::int32_t> corners = sorted(polygon);
  return std::adjacent_find(corners.begin(), corners.end()) != corners.end();
}

void find_degenerate_triangles(PolygonMesh& mesh) {
  const std::span<const double> coordinates = mesh.coordinates.numbers();
  const double per_unit = 1.0 / unit_of(coordinates);
  const std::span<const std::int32_t> corners = mesh.corners.numbers();
  const auto position = [&](std::size_t c) {
    return coordinates.data() + 3 * static_cast<std::size_t>(corners[c]);
  };
  for (std::size_t c = 0; c < corners.size(); c += 3) {
    for (std::size_t k = 0; k < 3 && c + k + 3 * kAhead < corners.size(); ++k) {
      prefetch(position(c + k + 3 * kAhead));
    }
    // One with a repeated corner has no area.
    if (has_no_area(position(c), position(c + 1), position(c + 2), per_unit)) {
      mesh.findings.add(Finding::degenerate_face, static_cast<std::int64_t>(c / 3));
    }
  }
}

void find_degenerate_faces(PolygonMesh& mesh) {
  if (mesh.has_only_triangles()) {
    find_degenerate_triangles(mesh);
    return;
  }
  const std::span<const double> coordinates = mesh.coordinates.numbers();
  const double per_unit = 1.0 / unit_of(coordinates);
  for_each_polygon(mesh, [&](Polygon polygon, std::int64_t number) {
    const auto position = [&](std::size_t corner) {
      return coordinates.data() + 3 * static_cast<std::size_t>(polygon[corner]);
    };
    if (repeats_a_corner(polygon) ||
        (polygon.size() == 3 && has_no_area(position(0), position(1), position(2), per_unit))) {
      mesh.findings.add(Finding::degenerate_face, number);
    }
  });
}

// The same for all orders of the corners: the least of them, and the sum of their squares.
template <typename Corners>
ItemKey key_of(const Corners& polygon) {
  if (polygon.empty()) return {};
  std::int32_t least = polygon[0];
  std::uint64_t sum = 0;
  for (const std::int32_t corner : polygon) {
    least = std::min(least, corner);
    const auto number = static_cast<std::uint64_t>(corner);
    sum += number * number;
  }
  return {static_cast<std::size_t>(least), mixed(0, sum)};
}

void find_duplicate_faces(PolygonMesh& mesh) {
  const auto is_before = [&](std::size_t i, std::size_t j) {
    return sorted(mesh.polygon(i)) < sorted(mesh.polygon(j));
  };
  const auto search = [&](auto key) {
    const auto buckets = static_cast<std::size_t>(mesh.vertex_count()) + 1;
    return repeated(mesh.polygon_count(), buckets, key, is_before);
  };
  const std::span<const std::int32_t> corners = mesh.corners.numbers();
  const std::vector<std::int32_t> found =
      mesh.has_only_triangles()
          ? search([&](std::size_t i) { return key_of(Triangle(corners.subspan(3 * i, 3))); })
          : search([&](std::size_t i) { return key_of(mesh.polygon(i)); });
  for (const std::int32_t face : found) {
    if (mesh.polygon(static_cast<std::size_t>(face)).size() < 3) continue;
    mesh.findings.add(Finding::duplicate_face, face);
  }
}

void find_odd_vertices(PolygonMesh& mesh) {
  for (const std::int32_t vertex : repeated_positions(mesh.coordinates.numbers())) {
    mesh.findings.add(Finding::coincident_vertex, vertex);
  }
  std::vector<char> used(static_cast<std::size_t>(mesh.vertex_count()), 0);  // faster than bits
  bool has_faces = false;
  for_each_polygon(mesh, [&](Polygon polygon, std::int64_t) {
    for (const std::int32_t vertex : polygon) used[static_cast<std::size_t>(vertex)] = 1;
    has_faces = true;
  });
  if (!has_faces) return;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v] == 0) mesh.findings.add(Finding::unused_vertex, static_cast<std::int64_t>(v));
  }
}

Faces triangles_of(PolygonMesh& mesh) {
  if (mesh.has_only_triangles()) return std::move(mesh.corners).take();
  std::vector<std::int32_t> triangles;
  triangles.reserve(mesh.corners.size());
  Triangulator triangulator(mesh.coordinates.numbers());
  for_each_polygon(mesh, [&](Polygon polygon, std::int64_t number) {
    if (!triangulator.split(polygon, triangles)) mesh.findings.add(Finding::crude_split, number);
    if (polygon.size() > 3) mesh.findings.add(Finding::triangulated, number);
  });
  return Eigen::Map<const Faces>(triangles.data(), std::ssize(triangles) / 3, 3);
}

}  // namespace

MeshFile assemble(PolygonMesh polygons) {
  if (polygons.findings.count(Finding::trailing_data) > 0 && polygons.polygon_count() == 0) {
    throw Error(ErrorKind::bad_input, "", "header", "no faces are declared, but more data follow");
  }
  if (polygons.coordinates.size() / 3 > kMost || polygons.corners.size() > kMost) {
    throw Error(ErrorKind::bad_input, "", "size", "more than 2147483647 vertices or corners");
  }
  find_dropped_elements(polygons);
  find_degenerate_faces(polygons);
  find_duplicate_faces(polygons);
  find_odd_vertices(polygons);
  MeshFile file;
  file.mesh.faces = triangles_of(polygons);
  if (file.mesh.faces.rows() == 0) polygons.findings.add_count(Finding::no_faces);
  file.mesh.vertices = std::move(polygons.coordinates).take();
  file.warnings = polygons.findings.warnings();
  return file;
}

}  // namespace timbre::detail
