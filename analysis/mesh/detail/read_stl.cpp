#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "timbre/analysis/mesh/detail/formats.h"
#include "timbre/analysis/mesh/detail/grouping.h"

namespace timbre::detail {
namespace {

// Neighbouring facets share their corners: that is the format's own rule, so equal positions
// become one vertex, numbered by first appearance.
class FacetMesh {
 public:
  FacetMesh(std::size_t expected_facets, bool soup) : soup_(soup), table_(expected_facets / 2) {
    mesh_.corners.reserve_rows(expected_facets);
    waiting_.reserve(kBlock);
  }

  /// Three of them make a facet.
  void add_corner(const PositionTable::Position& position) {
    // + 0.0 makes -0 to 0, so that the vertex does not depend on which of the two came first.
    waiting_.push_back(
        soup_ ? position
              : PositionTable::Position{position[0] + 0.0, position[1] + 0.0, position[2] + 0.0});
    if (waiting_.size() == kBlock) add_waiting();
  }
  void note_trailing_data() { mesh_.findings.add_count(Finding::trailing_data); }

  PolygonMesh take() && {
    add_waiting();
    const auto corners = static_cast<std::int64_t>(mesh_.corners.size());
    if (!soup_) mesh_.findings.add_count(Finding::welded, corners - mesh_.vertex_count());
    return std::move(mesh_);
  }

 private:
  static constexpr std::size_t kBlock = std::size_t{3} * 128;

  void add_waiting() {
    const std::size_t count = waiting_.size();
    constexpr auto kMost = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
    if (count > kMost - mesh_.corners.size()) {
      throw Error(ErrorKind::bad_input, "", "size", "more than 2147483647 corners");
    }
    auto next = static_cast<std::int32_t>(mesh_.corners.size());
    std::int32_t* const corners = mesh_.corners.extend(count);
    if (soup_) {
      std::iota(corners, corners + count, next);
      for (const auto& p : waiting_) mesh_.add_vertex(p[0], p[1], p[2]);
    } else {
      table_.number(waiting_, mesh_.coordinates, corners);
    }
    mesh_.end_triangles();
    waiting_.clear();
  }

  bool soup_;
  PositionTable table_;
  std::vector<PositionTable::Position> waiting_;
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
      PositionTable::Position position{};
      for (double& c : position) c = cursor_.number();
      if (const auto word = cursor_.word(); !word.empty()) {
        throw cursor_.error(in_quotes(word) + " is one value too many");
      }
      mesh_.add_corner(position);
    }
    line("endloop");
    line("endfacet");
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
  constexpr std::size_t kFacet = 50;
  constexpr std::size_t kNormal = 12;
  constexpr std::size_t kNumber = sizeof(float);
  cursor.take(80);
  const auto facets = cursor.value<std::uint32_t>(std::endian::little);
  FacetMesh mesh(facets, soup);
  for (std::uint32_t f = 0; f < facets; ++f) {
    cursor.enter("facet", f);
    const std::string_view facet = cursor.take(kFacet);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      PositionTable::Position position{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t at = kNormal + kNumber * (3 * corner + k);
        position[k] = value_of<float>(facet.substr(at), std::endian::little);
        if (!std::isfinite(position[k])) {
          throw cursor.error_at(cursor.last_offset() + at, "coordinate is not finite");
        }
      }
      mesh.add_corner(position);
    }
  }
  if (cursor.left() > 0) mesh.note_trailing_data();
  return std::move(mesh).take();
}

}  // namespace timbre::detail
