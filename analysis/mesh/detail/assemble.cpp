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

// The polygons of three or more corners.
struct Kept {
  std::vector<Polygon> polygons;
  std::vector<std::int32_t> number;  // of each in the file

  [[nodiscard]] std::size_t size() const { return number.size(); }
  [[nodiscard]] Polygon operator[](std::size_t i) const { return polygons[i]; }
};

Kept keep(PolygonMesh& mesh) {
  Kept kept;
  kept.polygons.reserve(mesh.ends.size());
  kept.number.reserve(mesh.ends.size());
  std::size_t begin = 0;
  for (std::size_t i = 0; i < mesh.ends.size(); begin = mesh.ends[i++]) {
    const auto number = static_cast<std::int32_t>(i);
    if (mesh.ends[i] - begin >= 3) {
      kept.polygons.push_back(Polygon(mesh.corners).subspan(begin, mesh.ends[i] - begin));
      kept.number.push_back(number);
    } else {
      mesh.findings.add(Finding::dropped_element, number);
    }
  }
  return kept;
}

bool repeats_a_corner(Polygon polygon, std::vector<std::int32_t>& scratch) {
  if (polygon.size() == 3) {
    return polygon[0] == polygon[1] || polygon[1] == polygon[2] || polygon[2] == polygon[0];
  }
  scratch.assign(polygon.begin(), polygon.end());
  std::sort(scratch.begin(), scratch.end());
  return std::adjacent_find(scratch.begin(), scratch.end()) != scratch.end();
}

void find_degenerate_faces(const Kept& kept, PolygonMesh& mesh) {
  const double* const xyz = mesh.coordinates.data();
  const double per_unit = 1.0 / unit_of(mesh.coordinates);
  std::vector<std::int32_t> scratch;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const Polygon polygon = kept[i];
    const auto position = [&](std::size_t corner) {
      return xyz + 3 * static_cast<std::size_t>(polygon[corner]);
    };
    if (repeats_a_corner(polygon, scratch) ||
        (polygon.size() == 3 && has_no_area(position(0), position(1), position(2), per_unit))) {
      mesh.findings.add(Finding::degenerate_face, kept.number[i]);
    }
  }
}

void sort(std::span<std::int32_t> corners) {
  if (corners.size() > 3) return std::sort(corners.begin(), corners.end());
  if (corners[0] > corners[1]) std::swap(corners[0], corners[1]);
  if (corners[1] > corners[2]) std::swap(corners[1], corners[2]);
  if (corners[0] > corners[1]) std::swap(corners[0], corners[1]);
}

void find_duplicate_faces(const Kept& kept, PolygonMesh& mesh) {
  std::vector<std::int32_t> sorted(mesh.corners);
  const auto key = [&](std::size_t i) {
    const Polygon polygon = kept[i];
    const auto begin = static_cast<std::size_t>(polygon.data() - mesh.corners.data());
    return std::span(sorted).subspan(begin, polygon.size());
  };
  for (std::size_t i = 0; i < kept.size(); ++i) sort(key(i));
  const auto first = first_equal(
      kept.size(), static_cast<std::size_t>(mesh.vertex_count()),
      [&](std::size_t i) { return static_cast<std::size_t>(key(i)[0]); },
      [&](std::size_t i, std::size_t j) {
        const auto a = key(i);
        const auto b = key(j);
        return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
      });
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (static_cast<std::size_t>(first[i]) != i) {
      mesh.findings.add(Finding::duplicate_face, kept.number[i]);
    }
  }
}

void find_odd_vertices(const Kept& kept, PolygonMesh& mesh) {
  const auto count = static_cast<std::size_t>(mesh.vertex_count());
  const auto first = first_at_position(mesh.coordinates.data(), count);
  std::vector<bool> used(count, kept.size() == 0);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    for (const std::int32_t vertex : kept[i]) used[static_cast<std::size_t>(vertex)] = true;
  }
  for (std::size_t v = 0; v < count; ++v) {
    const auto vertex = static_cast<std::int32_t>(v);
    if (first[v] != vertex) mesh.findings.add(Finding::coincident_vertex, vertex);
    if (!used[v]) mesh.findings.add(Finding::unused_vertex, vertex);
  }
}

std::vector<std::int32_t> triangles_of(const Kept& kept, PolygonMesh& mesh) {
  std::vector<std::int32_t> triangles;
  triangles.reserve(mesh.corners.size());
  Triangulator triangulator(mesh.coordinates);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (!triangulator.split(kept[i], triangles)) {
      mesh.findings.add(Finding::crude_split, kept.number[i]);
    }
    if (kept[i].size() > 3) mesh.findings.add(Finding::triangulated, kept.number[i]);
  }
  return triangles;
}

}  // namespace

MeshFile assemble(PolygonMesh polygons) {
  if (polygons.findings.count(Finding::trailing_data) > 0 && polygons.ends.empty()) {
    throw Error(ErrorKind::bad_input, "", "header", "no faces are declared, but more data follow");
  }
  if (polygons.coordinates.size() / 3 > kMost || polygons.corners.size() > kMost) {
    throw Error(ErrorKind::bad_input, "", "size", "more than 2147483647 vertices or corners");
  }
  const Kept kept = keep(polygons);
  find_degenerate_faces(kept, polygons);
  find_duplicate_faces(kept, polygons);
  find_odd_vertices(kept, polygons);
  const std::vector<std::int32_t> triangles = triangles_of(kept, polygons);
  if (triangles.empty()) polygons.findings.add_count(Finding::no_faces);

  MeshFile file;
  file.mesh.vertices =
      Eigen::Map<const Points>(polygons.coordinates.data(), polygons.vertex_count(), 3);
  file.mesh.faces =
      Eigen::Map<const Faces>(triangles.data(), static_cast<Eigen::Index>(triangles.size() / 3), 3);
  file.warnings = polygons.findings.warnings();
  return file;
}

}  // namespace timbre::detail
