#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "timbre/analysis/mesh/detail/cursor.h"
#include "timbre/analysis/mesh/detail/findings.h"
#include "timbre/analysis/mesh/detail/growing_rows.h"
#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre::detail {

/// What a file holds, before polygons are split.
class PolygonMesh {
 public:
  GrowingRows<Points> coordinates;  ///< x y z of each vertex
  GrowingRows<Faces> corners;       ///< of all polygons, one after the other; all in range
  Findings findings;

  void add_vertex(double x, double y, double z) {
    double* const xyz = coordinates.extend(3);
    xyz[0] = x;
    xyz[1] = y;
    xyz[2] = z;
  }
  /// The corners added since the last call make one polygon.
  void end_polygon() {
    const bool is_one_more_triangle = ends_.empty() && corners.size() == 3 * (polygons_ + 1);
    if (!is_one_more_triangle) note_end();
    ++polygons_;
  }
  /// The corners added since the last call make triangles, after nothing but triangles.
  void end_triangles() { polygons_ = corners.size() / 3; }
  [[nodiscard]] std::int64_t vertex_count() const {
    return static_cast<std::int64_t>(coordinates.size() / 3);
  }
  [[nodiscard]] std::size_t polygon_count() const { return polygons_; }
  [[nodiscard]] bool has_only_triangles() const { return ends_.empty(); }
  /// The corners of a polygon.
  [[nodiscard]] std::span<const std::int32_t> polygon(std::size_t i) const {
    if (ends_.empty()) return corners.numbers().subspan(3 * i, 3);
    const std::size_t begin = i == 0 ? 0 : ends_[i - 1];
    return corners.numbers().subspan(begin, ends_[i] - begin);
  }

 private:
  void note_end() {
    for (std::size_t i = ends_.size(); i < polygons_; ++i) ends_.push_back(3 * (i + 1));
    ends_.push_back(corners.size());
  }

  std::size_t polygons_ = 0;
  std::vector<std::size_t> ends_;  // where each ends in `corners`; empty while all are triangles
};

enum class FileFormat : std::uint8_t {
  off,
  obj,
  ply,
  stl_text,
  stl_binary,
  freesurfer_text,
  freesurfer_binary,
  vtk,
  glb,
};

/// Tells the format by content first and by the name's ending second.
///
/// @param head  the first bytes of the file, perhaps all
/// @param size  of the whole file
/// @return nothing if a longer head is needed
/// @throws Error  bad_input if this is no mesh, with what it seems to be
[[nodiscard]] std::optional<FileFormat> detect_format(std::string_view head, std::uint64_t size,
                                                      std::string_view name);

/// The text without a UTF-8 byte order mark.
[[nodiscard]] std::string_view without_mark(std::string_view text);

/// The readers, one for each format; `cursor` stands at the beginning.
/// @throws Error  bad_input with place and cause
[[nodiscard]] PolygonMesh read_off(Cursor cursor);
[[nodiscard]] PolygonMesh read_obj(Cursor cursor);
[[nodiscard]] PolygonMesh read_ply(Cursor cursor);
/// @param soup  keep the corners of all facets apart
[[nodiscard]] PolygonMesh read_stl_text(Cursor cursor, bool soup);
[[nodiscard]] PolygonMesh read_stl_binary(Cursor cursor, bool soup);
[[nodiscard]] PolygonMesh read_freesurfer_text(Cursor cursor);
[[nodiscard]] PolygonMesh read_freesurfer_binary(Cursor cursor);
[[nodiscard]] PolygonMesh read_vtk(Cursor cursor);
/// Binary glTF 2: the meshes of the default scene, where its nodes place them. A mesh that n
/// nodes place is there n times. Primitives of one mesh that name the same positions share their
/// vertices; no others are joined. Skinned and morphed meshes stand as they were modelled.
[[nodiscard]] PolygonMesh read_glb(Cursor cursor);

}  // namespace timbre::detail
