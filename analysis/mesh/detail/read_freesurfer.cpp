#include <cmath>

#include "timbre/analysis/mesh/detail/formats.h"
#include "timbre/analysis/mesh/detail/plain_points.h"

namespace timbre::detail {
namespace {

constexpr std::endian kOrder = std::endian::big;

// The magics; 0xfffffd, new quads, has counts of 3 bytes and float32.
constexpr std::uint32_t kTriangles = 0xfffffe;  // text, counts of 4 bytes, float32
constexpr std::uint32_t kOldQuads = 0xffffff;   // counts of 3 bytes, hundredths in int16

std::uint32_t three_bytes(Cursor& cursor) {
  std::uint32_t value = 0;
  for (const char c : cursor.take(3)) value = value << 8U | static_cast<unsigned char>(c);
  return value;
}

// The magic is followed by who made the file, and by an empty line.
void skip_stamp(Cursor& cursor) {
  for (int line = 0; line < 2; ++line) {
    const std::size_t end = cursor.rest().find('\n');
    if (end == std::string_view::npos)
      throw cursor.error("truncated: two lines of text are needed");
    cursor.take(end + 1);
  }
}

// lh.curv, lh.thickness and their like share the magic of old quads. Their three counts of 4
// bytes are vertices, faces, and values of each vertex, which are 1.
void refuse_values(Cursor ahead) {
  if (ahead.left() < 12) return;
  const auto vertices = ahead.value<std::uint32_t>(kOrder);
  ahead.value<std::uint32_t>(kOrder);
  const Error error = ahead.error_at(0, "values of vertices (curvature, thickness), not a surface");
  if (ahead.value<std::uint32_t>(kOrder) == 1 && ahead.left() == std::uint64_t{4} * vertices) {
    throw error;
  }
}

struct Counts {
  std::int64_t vertices = 0;
  std::int64_t faces = 0;
};

Counts read_counts(Cursor& cursor, std::uint32_t magic) {
  const auto next = [&](std::uint64_t least_bytes, const char* elements) {
    const std::int64_t count = magic == kTriangles
                                   ? std::int64_t{cursor.value<std::int32_t>(kOrder)}
                                   : std::int64_t{three_bytes(cursor)};
    return cursor.checked_count(count, least_bytes, elements);
  };
  const std::int64_t vertices = next(magic == kOldQuads ? 6 : 12, "vertices");
  return {vertices, next(12, "faces")};
}

double coordinate(Cursor& cursor, std::uint32_t magic) {
  constexpr double kUnits = 100.0;
  if (magic == kOldQuads) return cursor.value<std::int16_t>(kOrder) / kUnits;
  const double value = cursor.value<float>(kOrder);
  if (!std::isfinite(value)) throw cursor.error("coordinate is not finite");
  return value;
}

std::int64_t corner(Cursor& cursor, std::uint32_t magic) {
  return magic == kTriangles ? std::int64_t{cursor.value<std::int32_t>(kOrder)}
                             : std::int64_t{three_bytes(cursor)};
}

// The command lines and the geometry of the volume that many files end with.
bool is_tag(Cursor ahead) {
  constexpr std::uint32_t kLastTag = 60;
  if (ahead.left() < 4) return false;
  const auto tag = ahead.value<std::uint32_t>(kOrder);
  return tag > 0 && tag <= kLastTag;
}

void reserve(PolygonMesh& mesh, const Counts& counts) {
  mesh.coordinates.reserve_rows(static_cast<std::size_t>(counts.vertices));
  mesh.corners.reserve_rows(static_cast<std::size_t>(counts.faces));
}

// Goes to the next row. The number after its three, which marks what was cut off from the
// surface, may be missing.
void next_row(Cursor& cursor, const char* kind, std::int64_t index) {
  cursor.skip_line();
  cursor.enter(kind, index);
  if (!cursor.seek_word()) throw cursor.truncated();
}

void end_row(Cursor& cursor) {
  if (cursor.word().empty()) return;
  if (const auto word = cursor.word(); !word.empty()) {
    throw cursor.error(in_quotes(word) + " is one value too many");
  }
}

}  // namespace

PolygonMesh read_freesurfer_binary(Cursor cursor) {
  const std::uint32_t magic = three_bytes(cursor);
  if (magic == kTriangles) skip_stamp(cursor);
  if (magic == kOldQuads) refuse_values(cursor);
  const Counts counts = read_counts(cursor, magic);
  PolygonMesh mesh;
  reserve(mesh, counts);
  std::int64_t plain = 0;
  if (magic != kOldQuads) plain = read_plain_points<float>(cursor, counts.vertices, kOrder, mesh);
  for (std::int64_t i = plain; i < counts.vertices; ++i) {
    cursor.enter("vertex", i);
    const double x = coordinate(cursor, magic);
    const double y = coordinate(cursor, magic);
    mesh.add_vertex(x, y, coordinate(cursor, magic));
  }
  const int corners = magic == kTriangles ? 3 : 4;
  for (std::int64_t i = 0; i < counts.faces; ++i) {
    cursor.enter("face", i);
    for (int c = 0; c < corners; ++c) {
      mesh.corners.push_back(cursor.checked_index(corner(cursor, magic), counts.vertices));
    }
    mesh.end_polygon();
  }
  if (!is_tag(cursor) && cursor.rest().find_first_not_of(" \t\r\n\v\f") != std::string_view::npos) {
    mesh.findings.add_count(Finding::trailing_data);
  }
  return mesh;
}

PolygonMesh read_freesurfer_text(Cursor cursor) {
  constexpr std::uint64_t kRowBytes = 6;        // "0 0 0\n"
  cursor.expect_text({.hash_comments = true});  // the first line begins with #!ascii
  cursor.refuse_nul();
  if (!cursor.seek_word()) throw cursor.truncated();
  const std::int64_t vertices = cursor.checked_count(cursor.integer(), kRowBytes, "vertices");
  const std::int64_t faces = cursor.checked_count(cursor.integer(), kRowBytes, "faces");
  if (const auto word = cursor.word(); !word.empty()) {
    throw cursor.error(in_quotes(word) + " is one count too many");
  }
  PolygonMesh mesh;
  reserve(mesh, {vertices, faces});
  for (std::int64_t i = 0; i < vertices; ++i) {
    next_row(cursor, "vertex", i);
    const double x = cursor.number();
    const double y = cursor.number();
    mesh.add_vertex(x, y, cursor.number());
    end_row(cursor);
  }
  for (std::int64_t i = 0; i < faces; ++i) {
    next_row(cursor, "face", i);
    for (int c = 0; c < 3; ++c) mesh.corners.push_back(cursor.vertex_index(vertices));
    mesh.end_polygon();
    end_row(cursor);
  }
  cursor.skip_line();
  if (cursor.seek_word()) mesh.findings.add_count(Finding::trailing_data);
  return mesh;
}

}  // namespace timbre::detail
