#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "timbre/analysis/mesh/detail/formats.h"
#include "timbre/analysis/mesh/detail/grouping.h"

namespace timbre::detail {
namespace {

// Neighbouring facets share their corners: that is the format's own rule, so equal positions
// become one vertex, numbered by first appearance.
class FacetMesh {
 public:
  FacetMesh(std::size_t expected_facets, bool soup) : soup_(soup), table_(expected_facets / 2) {}

  void add_corner(const std::array<double, 3>& position) {
    if (mesh_.corners.size() ==
        static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
      throw Error(ErrorKind::bad_input, "", "size", "more than 2147483647 corners");
    }
    if (soup_) {
      mesh_.corners.push_back(static_cast<std::int32_t>(mesh_.vertex_count()));
      mesh_.add_vertex(position[0], position[1], position[2]);
    } else {
      // + 0.0 makes -0 to 0, so that the vertex does not depend on which of the two came first.
      mesh_.corners.push_back(table_.number_of(
          {position[0] + 0.0, position[1] + 0.0, position[2] + 0.0}, mesh_.coordinates));
    }
  }
  void end_facet() { mesh_.end_polygon(); }
  void note_trailing_data() { mesh_.findings.add_count(Finding::trailing_data); }

  PolygonMesh take() && {
    const auto corners = static_cast<std::int64_t>(mesh_.corners.size());
    if (!soup_) mesh_.findings.add_count(Finding::welded, corners - mesh_.vertex_count());
    return std::move(mesh_);
  }

 private:
  bool soup_;
  PositionTable table_;
  PolygonMesh mesh_;
};

class StlTextReader {
 public:
  StlTextReader(const Cursor& cursor, bool soup)
      : cursor_(cursor), mesh_(cursor.left() / kUsualFacet, soup) {}

  PolygonMesh read() {
    while (cursor_.seek_word()) {
      if (!is("solid", cursor_.word())) throw unexpected("solid");
      for (next(); !is("endsolid", word_); next()) facet();  // what is left on the line is a name
      cursor_.skip_line();
    }
    return std::move(mesh_).take();
  }

 private:
  static constexpr std::size_t kUsualFacet = 200;  // bytes

  void facet() {
    if (!is("facet", word_) || !is("normal", cursor_.word())) {
      throw unexpected("facet normal' or 'endsolid");
    }
    if (cursor_.count_words() != 3) throw cursor_.error("a normal needs 3 numbers");
    line("outer", "loop");
    for (int corner = 0; corner < 3; ++corner) {
      next();
      if (!is("vertex", word_)) throw unexpected("vertex");
      std::array<double, 3> position{};
      for (double& c : position) c = cursor_.number();
      if (const auto word = cursor_.word(); !word.empty()) {
        throw cursor_.error(in_quotes(word) + " is one value too many");
      }
      mesh_.add_corner(position);
    }
    line("endloop");
    line("endfacet");
    mesh_.end_facet();
  }

  // The first word of the next line that has one.
  void next() {
    cursor_.skip_line();
    if (!cursor_.seek_word()) throw cursor_.truncated();
    word_ = cursor_.word();
  }

  // A line of one word or of two.
  void line(std::string_view first, std::string_view second = {}) {
    next();
    if (!is(first, word_) || !is(second, cursor_.word()) || !cursor_.word().empty()) {
      throw unexpected(std::string(first) + (second.empty() ? "" : " ") + std::string(second));
    }
  }

  static bool is(std::string_view expected, std::string_view word) {
    return std::equal(
        word.begin(), word.end(), expected.begin(), expected.end(),
        [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; });
  }

  [[nodiscard]] Error unexpected(const std::string& expected) const {
    return cursor_.error("unexpected words; '" + expected + "' is needed");
  }

  Cursor cursor_;
  FacetMesh mesh_;
  std::string_view word_;
};

}  // namespace

PolygonMesh read_stl_text(Cursor cursor, bool soup) {
  cursor.expect_text({});
  cursor.refuse_nul();
  return StlTextReader(cursor, soup).read();
}

PolygonMesh read_stl_binary(Cursor cursor, bool soup) {
  constexpr std::uint64_t kNormal = 12;
  constexpr std::uint64_t kAttribute = 2;
  cursor.take(80);
  const auto facets = cursor.value<std::uint32_t>(std::endian::little);
  FacetMesh mesh(facets, soup);
  for (std::uint32_t f = 0; f < facets; ++f) {
    cursor.enter("facet", f);
    cursor.take(kNormal);
    for (int corner = 0; corner < 3; ++corner) {
      std::array<double, 3> position{};
      for (double& c : position) {
        c = cursor.value<float>(std::endian::little);
        if (!std::isfinite(c)) throw cursor.error("coordinate is not finite");
      }
      mesh.add_corner(position);
    }
    mesh.end_facet();
    cursor.take(kAttribute);
  }
  if (cursor.left() > 0) mesh.note_trailing_data();
  return std::move(mesh).take();
}

}  // namespace timbre::detail
