#include <algorithm>
#include <cmath>

#include "timbre/analysis/mesh/detail/formats.h"
#include "timbre/analysis/mesh/detail/grouping.h"

namespace timbre::detail {
namespace {

std::string lower(std::string_view word) {
  std::string text(word);
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

// Neighbouring facets share their corners: that is the format's own rule, so equal positions
// become one vertex, numbered by first appearance.
PolygonMesh mesh_of_facets(std::vector<double> corners, bool soup, Findings findings) {
  const std::size_t count = corners.size() / 3;
  if (count > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
    throw Error(ErrorKind::bad_input, "", "size", "more than 2147483647 corners");
  }
  PolygonMesh mesh;
  mesh.findings = std::move(findings);
  mesh.corners.resize(count);
  for (std::size_t end = 3; end <= count; end += 3) mesh.ends.push_back(end);
  if (soup) {
    for (std::size_t i = 0; i < count; ++i) mesh.corners[i] = static_cast<std::int32_t>(i);
    mesh.coordinates = std::move(corners);
    return mesh;
  }
  const std::vector<std::int32_t> first = first_at_position(corners.data(), count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto leader = static_cast<std::size_t>(first[i]);
    if (leader == i) {
      mesh.corners[i] = static_cast<std::int32_t>(mesh.vertex_count());
      // + 0.0 makes -0 to 0, so that the vertex does not depend on which of the two came first.
      mesh.add_vertex(corners[3 * i] + 0.0, corners[3 * i + 1] + 0.0, corners[3 * i + 2] + 0.0);
    } else {
      mesh.corners[i] = mesh.corners[leader];
    }
  }
  const std::int64_t welded = static_cast<std::int64_t>(count) - mesh.vertex_count();
  mesh.findings.add_count(Finding::welded, welded);
  return mesh;
}

class StlTextReader {
 public:
  explicit StlTextReader(const Cursor& cursor) : cursor_(cursor) {}

  std::vector<double> read() {
    while (cursor_.seek_word()) {
      if (lower(cursor_.word()) != "solid") throw unexpected("solid");
      for (next(); !is("endsolid"); next()) facet();  // what is left on the line is a name
      cursor_.skip_line();
    }
    return std::move(corners_);
  }

 private:
  void facet() {
    if (!is("facet") || lower(cursor_.word()) != "normal") {
      throw unexpected("facet normal' or 'endsolid");
    }
    if (cursor_.count_words() != 3) throw cursor_.error("a normal needs 3 numbers");
    line("outer loop");
    for (int corner = 0; corner < 3; ++corner) {
      next();
      if (!is("vertex")) throw unexpected("vertex");
      for (int k = 0; k < 3; ++k) corners_.push_back(cursor_.number());
      end_line();
    }
    line("endloop");
    line("endfacet");
  }

  // The first word of the next line that has one.
  void next() {
    cursor_.skip_line();
    if (!cursor_.seek_word()) throw cursor_.truncated();
    word_ = lower(cursor_.word());
  }

  void line(const std::string& expected) {
    next();
    std::string words = word_;
    for (auto more = cursor_.word(); !more.empty(); more = cursor_.word())
      words += " " + lower(more);
    if (words != expected) throw unexpected(expected);
  }

  void end_line() {
    if (const auto word = cursor_.word(); !word.empty()) {
      throw cursor_.error(in_quotes(word) + " is one value too many");
    }
  }

  [[nodiscard]] bool is(std::string_view expected) const { return word_ == expected; }

  [[nodiscard]] Error unexpected(const std::string& expected) const {
    return cursor_.error("unexpected words; '" + expected + "' is needed");
  }

  Cursor cursor_;
  std::string word_;
  std::vector<double> corners_;
};

}  // namespace

PolygonMesh read_stl_text(Cursor cursor, bool soup) {
  cursor.expect_text({});
  cursor.refuse_nul();
  return mesh_of_facets(StlTextReader(cursor).read(), soup, {});
}

PolygonMesh read_stl_binary(Cursor cursor, bool soup) {
  constexpr std::uint64_t kNormal = 12;
  constexpr std::uint64_t kAttribute = 2;
  cursor.take(80);
  const auto facets = cursor.value<std::uint32_t>(std::endian::little);
  std::vector<double> corners;
  corners.reserve(9 * static_cast<std::size_t>(facets));
  for (std::uint32_t f = 0; f < facets; ++f) {
    cursor.enter("facet", f);
    cursor.take(kNormal);
    for (int k = 0; k < 9; ++k) {
      const auto value = cursor.value<float>(std::endian::little);
      if (!std::isfinite(value)) throw cursor.error("coordinate is not finite");
      corners.push_back(value);
    }
    cursor.take(kAttribute);
  }
  Findings findings;
  if (cursor.left() > 0) findings.add_count(Finding::trailing_data);
  return mesh_of_facets(std::move(corners), soup, std::move(findings));
}

}  // namespace timbre::detail
