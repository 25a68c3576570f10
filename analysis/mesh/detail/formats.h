#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "timbre/analysis/mesh/detail/cursor.h"
#include "timbre/analysis/mesh/detail/findings.h"

namespace timbre::detail {

/// What a file holds, before polygons are split.
struct PolygonMesh {
  std::vector<double> coordinates;    ///< x y z of each vertex
  std::vector<std::int32_t> corners;  ///< of all polygons, one after the other; all in range
  std::vector<std::size_t> ends;      ///< for each polygon, where it ends in `corners`
  Findings findings;

  void add_vertex(double x, double y, double z) {
    coordinates.insert(coordinates.end(), {x, y, z});
  }
  /// The corners added since the last call make one polygon.
  void end_polygon() { ends.push_back(corners.size()); }
  [[nodiscard]] std::int64_t vertex_count() const {
    return static_cast<std::int64_t>(coordinates.size() / 3);
  }
};

enum class FileFormat : std::uint8_t { off, obj, ply, stl_text, stl_binary };

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

}  // namespace timbre::detail
