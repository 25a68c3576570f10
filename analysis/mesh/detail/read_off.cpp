#include <algorithm>
#include <cmath>

#include "timbre/analysis/core/number_text.h"
#include "timbre/analysis/mesh/detail/formats.h"
#include "timbre/analysis/mesh/detail/plain_points.h"

namespace timbre::detail {
namespace {

// What stands in a vertex line, by the letters before OFF: x y z [w] [nx ny nz] [colour] [s t].
struct Layout {
  bool texture = false;
  bool colour = false;
  bool normal = false;
  bool homogeneous = false;
  bool dimension = false;  // the header says how many dimensions there are

  [[nodiscard]] std::size_t values_without_colour() const {
    return 3U + (homogeneous ? 1U : 0U) + (normal ? 3U : 0U) + (texture ? 2U : 0U);
  }
};

bool drop_prefix(std::string_view& text, std::string_view prefix) {
  if (!text.starts_with(prefix)) return false;
  text.remove_prefix(prefix.size());
  return true;
}

Layout layout_of(std::string_view keyword) {
  Layout layout;
  layout.texture = drop_prefix(keyword, "ST");
  layout.colour = drop_prefix(keyword, "C");
  layout.normal = drop_prefix(keyword, "N");
  layout.homogeneous = drop_prefix(keyword, "4");
  layout.dimension = drop_prefix(keyword, "n");
  return layout;
}

struct Counts {
  std::int64_t vertices = 0;
  std::int64_t faces = 0;
};

Counts checked(const Cursor& cursor, std::int64_t vertices, std::int64_t faces,
               std::uint64_t vertex_bytes, std::uint64_t face_bytes) {
  const Counts counts{cursor.checked_count(vertices, vertex_bytes, "vertices"),
                      cursor.checked_count(faces, face_bytes, "faces")};
  const auto needed = static_cast<std::uint64_t>(counts.vertices) * vertex_bytes +
                      static_cast<std::uint64_t>(counts.faces) * face_bytes;
  if (needed > cursor.left() + 1) {
    throw cursor.error("vertices and faces are declared, more than the file can hold");
  }
  return counts;
}

void require_three_dimensions(Cursor& cursor) {
  if (!cursor.seek_word()) throw cursor.truncated();
  if (const auto dimensions = cursor.integer(); dimensions != 3) {
    throw cursor.error(std::to_string(dimensions) + " dimensions; only 3 are read");
  }
}

// The counts of vertices, faces and, perhaps missing and never used, edges. They may stand
// on the line of the keyword; `glued` is the first of them where it belongs to the keyword.
Counts read_counts(Cursor& cursor, std::string_view glued) {
  std::int64_t vertices = 0;
  if (glued.empty()) {
    if (!cursor.seek_word()) throw cursor.truncated();
    vertices = cursor.integer();
  } else if (const auto value = parse_integer(glued)) {
    vertices = *value;
  } else {
    throw cursor.error(in_quotes(glued) + " is not an integer of 64 bits");
  }
  const std::int64_t faces = cursor.integer();
  for (std::string_view edges = cursor.word(); !edges.empty(); edges = cursor.word()) {
    if (!parse_integer(edges))
      throw cursor.error(in_quotes(edges) + " is not an integer of 64 bits");
  }
  constexpr std::uint64_t kVertexBytes = 6;  // "0 0 0\n"
  constexpr std::uint64_t kFaceBytes = 2;    // "0\n"
  return checked(cursor, vertices, faces, kVertexBytes, kFaceBytes);
}

void read_vertex(Cursor& cursor, const Layout& layout, std::int64_t index, PolygonMesh& mesh) {
  double x = cursor.number();
  double y = cursor.number();
  double z = cursor.number();
  std::size_t values = 3;
  if (layout.homogeneous) {
    const double w = cursor.number();
    if (w == 0.0) throw cursor.error("w is 0: a point at infinity");
    x /= w;
    y /= w;
    z /= w;
    if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) {
      throw cursor.error("x y z over w are beyond the range of a double");
    }
    ++values;
  }
  values += cursor.count_words();
  const std::size_t least = layout.values_without_colour() + (layout.colour ? 3U : 0U);
  const std::size_t most = layout.values_without_colour() + (layout.colour ? 4U : 0U);
  if (values < least || (layout.colour && values > most)) {
    throw cursor.error(std::to_string(values) + " values; the header asks for " +
                       std::to_string(least) + (layout.colour ? " or one more" : ""));
  }
  if (values > most) mesh.findings.add(Finding::extra_values, index);
  mesh.add_vertex(x, y, z);
}

void read_face(Cursor& cursor, std::int64_t vertices, PolygonMesh& mesh) {
  const std::int64_t corners = cursor.integer();
  if (corners < 0) throw cursor.error(std::to_string(corners) + " corners");
  for (std::int64_t c = 0; c < corners; ++c) mesh.corners.push_back(cursor.vertex_index(vertices));
  mesh.end_polygon();
}

PolygonMesh read_text(Cursor& cursor, const Layout& layout, const Counts& counts) {
  PolygonMesh mesh;
  mesh.coordinates.reserve_rows(static_cast<std::size_t>(counts.vertices));
  mesh.corners.reserve_rows(static_cast<std::size_t>(counts.faces));
  const auto next_line = [&](const char* kind, std::int64_t index) {
    cursor.skip_line();
    cursor.enter(kind, index);
    if (!cursor.seek_word()) throw cursor.truncated();
  };
  for (std::int64_t i = 0; i < counts.vertices; ++i) {
    next_line("vertex", i);
    read_vertex(cursor, layout, i, mesh);
  }
  for (std::int64_t i = 0; i < counts.faces; ++i) {
    next_line("face", i);
    read_face(cursor, counts.vertices, mesh);
  }
  cursor.skip_line();
  if (cursor.seek_word()) mesh.findings.add_count(Finding::trailing_data);
  return mesh;
}

double finite_coordinate(Cursor& cursor, std::endian order) {
  const auto value = cursor.value<float>(order);
  if (!std::isfinite(value)) throw cursor.error("coordinate is not finite");
  return value;
}

// Triangles up to the first face that is odd in any way; returns how many. Each is a row of
// 32-bit integers: 3, its corners, and 0 if there is a number of colours.
std::int64_t read_plain_triangles(Cursor& cursor, const Counts& counts, std::endian order,
                                  bool has_colours, PolygonMesh& mesh) {
  const std::size_t size = has_colours ? 20 : 16;
  const std::size_t rows = std::min(static_cast<std::size_t>(counts.faces), cursor.left() / size);
  std::int32_t* const corners = mesh.corners.extend(3 * rows);
  const std::string_view bytes = cursor.rest();
  std::size_t read = 0;
  for (; read < rows; ++read) {
    const std::string_view row = bytes.substr(read * size, size);
    const auto number = [&](std::size_t i) {
      return value_of<std::uint32_t>(row.substr(4 * i), order);
    };
    bool is_plain = number(0) == 3 && (!has_colours || number(4) == 0);
    for (std::size_t i = 1; i <= 3; ++i) {
      is_plain = is_plain && number(i) < counts.vertices;
      corners[3 * read + i - 1] = static_cast<std::int32_t>(number(i));
    }
    if (!is_plain) break;
  }
  mesh.corners.shrink(3 * (rows - read));
  mesh.end_triangles();
  cursor.take(read * size);
  return static_cast<std::int64_t>(read);
}

PolygonMesh read_binary(Cursor cursor, std::endian order) {
  const auto integer = [&] { return cursor.value<std::int32_t>(order); };
  const std::int64_t vertices = integer();
  const std::int64_t faces = integer();
  (void)integer();  // edges, never used
  constexpr std::uint64_t kVertexBytes = 12;
  constexpr std::uint64_t kFaceBytes = 4;
  const Counts counts = checked(cursor, vertices, faces, kVertexBytes, kFaceBytes);

  PolygonMesh mesh;
  mesh.coordinates.reserve_rows(static_cast<std::size_t>(counts.vertices));
  mesh.corners.reserve_rows(static_cast<std::size_t>(counts.faces));
  std::int64_t i = read_plain_points<float>(cursor, counts.vertices, order, mesh);
  for (; i < counts.vertices; ++i) {
    cursor.enter("vertex", i);
    const double x = finite_coordinate(cursor, order);
    const double y = finite_coordinate(cursor, order);
    mesh.add_vertex(x, y, finite_coordinate(cursor, order));
  }
  const bool has_colours = order == std::endian::big;  // other writers know none
  i = read_plain_triangles(cursor, counts, order, has_colours, mesh);
  for (; i < counts.faces; ++i) {
    cursor.enter("face", i);
    const std::int64_t corners = cursor.checked_count(integer(), 4, "corners");
    for (std::int64_t c = 0; c < corners; ++c) {
      mesh.corners.push_back(cursor.checked_index(integer(), counts.vertices));
    }
    mesh.end_polygon();
    if (!has_colours) continue;
    cursor.take(4 * static_cast<std::uint64_t>(cursor.checked_count(integer(), 4, "colours")));
  }
  if (cursor.rest().find_first_not_of(" \t\r\n\v\f") != std::string_view::npos) {
    mesh.findings.add_count(Finding::trailing_data);
  }
  return mesh;
}

// The format is big-endian, yet the files of some writers (pmp-library) are as their
// machine: no count makes sense in both orders unless it is tiny or the file enormous.
std::endian byte_order(Cursor cursor) {
  const auto fits = [&cursor](std::endian order) {
    Cursor ahead = cursor;
    const std::int64_t vertices = ahead.value<std::int32_t>(order);
    const std::int64_t faces = ahead.value<std::int32_t>(order);
    return vertices >= 0 && faces >= 0 &&
           static_cast<std::uint64_t>(12 * vertices + 4 * faces) <= ahead.left();
  };
  return !fits(std::endian::big) && fits(std::endian::little) ? std::endian::little
                                                              : std::endian::big;
}

}  // namespace

PolygonMesh read_off(Cursor cursor) {
  cursor.expect_text({.hash_comments = true});
  if (!cursor.seek_word()) throw cursor.truncated();
  const std::string_view keyword = cursor.word();
  const Layout layout = layout_of(keyword);
  const std::string_view glued = keyword.substr(keyword.find_first_of("Ff") + 2);
  if (Cursor ahead = cursor; keyword == "OFF" && ahead.word() == "BINARY") {
    ahead.skip_line();
    ahead.expect_binary();
    return read_binary(ahead, byte_order(ahead));
  }
  cursor.refuse_nul();
  if (layout.dimension) require_three_dimensions(cursor);
  const Counts counts = read_counts(cursor, glued);
  PolygonMesh mesh = read_text(cursor, layout, counts);
  if (!glued.empty()) mesh.findings.add_count(Finding::glued_header);
  return mesh;
}

}  // namespace timbre::detail
