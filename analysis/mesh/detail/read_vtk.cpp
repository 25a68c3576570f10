#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "timbre/analysis/mesh/detail/formats.h"
#include "timbre/analysis/mesh/detail/plain_points.h"

namespace timbre::detail {
namespace {

struct NumberType {
  std::string_view name;
  std::uint64_t size = 0;  // bytes, in a binary file
  bool real = false;
  bool has_sign = true;
};

constexpr std::array<NumberType, 16> kTypes = {{
    {"float", 4, true},
    {"double", 8, true},
    {"char", 1},
    {"signed_char", 1},
    {"unsigned_char", 1, false, false},
    {"short", 2},
    {"unsigned_short", 2, false, false},
    {"int", 4},
    {"unsigned_int", 4, false, false},
    {"vtkidtype", 4},
    {"long", 8},
    {"unsigned_long", 8, false, false},
    {"vtktypeint32", 4},
    {"vtktypeint64", 8},
    {"vtktypeuint32", 4, false, false},
    {"vtktypeuint64", 8, false, false},
}};

constexpr NumberType kInt = {"int", 4};

// Corners of cells, one after the other, and where each ends.
struct Cells {
  std::vector<std::int32_t> corners;
  std::vector<std::size_t> ends;

  [[nodiscard]] std::span<const std::int32_t> cell(std::size_t i) const {
    const std::size_t begin = i == 0 ? 0 : ends[i - 1];
    return std::span(corners).subspan(begin, ends[i] - begin);
  }
};

class VtkReader {
 public:
  explicit VtkReader(const Cursor& cursor) : cursor_(cursor) {}

  PolygonMesh read() {
    header();
    while (cursor_.seek_word()) {
      const std::string word = keyword();
      if (word == "point_data" || word == "cell_data") break;
      section(word);
    }
    if (!has_points_) throw missing("POINTS");
    if (!has_faces_) throw missing(is_grid_ ? "CELLS and CELL_TYPES" : "POLYGONS");
    return std::move(mesh_);
  }

 private:
  void header() {
    cursor_.expect_text({});
    cursor_.skip_line();  // the version
    cursor_.skip_line();  // a title
    if (!cursor_.seek_word()) throw cursor_.truncated();
    const std::string form = keyword();
    binary_ = form == "binary";
    if (!binary_ && form != "ascii") throw cursor_.error("'ASCII' or 'BINARY' is needed");
    if (!binary_) cursor_.refuse_nul();
    cursor_.skip_line();
    if (!cursor_.seek_word()) throw cursor_.truncated();
    if (keyword() != "dataset") throw cursor_.error("'DATASET' is needed");
    const std::string kind = keyword();
    is_grid_ = kind == "unstructured_grid";
    if (!is_grid_ && kind != "polydata") {
      throw cursor_.error(in_quotes(kind) +
                          " has no faces; POLYDATA and UNSTRUCTURED_GRID are read");
    }
    cursor_.skip_line();
  }

  void section(const std::string& word) {
    if (word == "points") return points();
    if (word == "metadata") return skip_metadata();
    if (word == "field") return skip_field();
    if (!is_grid_ && (word == "vertices" || word == "lines")) return drop(cells());
    if (!is_grid_ && word == "polygons") return polygons(cells());
    if (!is_grid_ && word == "triangle_strips") return strips(cells());
    if (is_grid_ && word == "cells") {
      grid_ = cells();
      return;
    }
    if (is_grid_ && word == "cell_types") return cell_types();
    throw cursor_.error(in_quotes(word) + " is no section of this dataset");
  }

  void points() {
    if (has_points_) throw cursor_.error("POINTS stand twice");
    const std::int64_t declared = cursor_.integer();
    const std::size_t place = cursor_.last_offset();
    const NumberType& type = number_type();
    check(place, declared, 3 * least_bytes(type), "points");
    begin_data();
    mesh_.coordinates.reserve_rows(static_cast<std::size_t>(declared));
    for (std::int64_t i = plain_points(declared, type); i < declared; ++i) {
      cursor_.enter("vertex", i);
      const double x = coordinate(type);
      const double y = coordinate(type);
      mesh_.add_vertex(x, y, coordinate(type));
    }
    end_data();
    has_points_ = true;
  }

  std::int64_t plain_points(std::int64_t count, const NumberType& type) {
    if (!binary_ || !type.real) return 0;
    return type.size == 4 ? read_plain_points<float>(cursor_, count, std::endian::big, mesh_)
                          : read_plain_points<double>(cursor_, count, std::endian::big, mesh_);
  }

  // Either counts and corners in turn, or, since version 5.1, two arrays.
  Cells cells() {
    if (!has_points_) throw cursor_.error("POINTS must stand before the cells");
    const std::int64_t first = cursor_.integer();
    const std::size_t place = cursor_.last_offset();
    const std::int64_t second = cursor_.integer();
    const std::size_t second_place = cursor_.last_offset();
    if (binary_) cursor_.skip_line();
    check(place, first, least_bytes(kInt), "cells");
    check(second_place, second, least_bytes(kInt), "numbers of cells");
    Cursor ahead = cursor_;
    if (ahead.seek_word() && ahead.word() == "OFFSETS") {
      cursor_ = ahead;
      return cells_of_arrays(first, second);
    }
    if (binary_) cursor_.expect_binary();
    Cells found;
    std::int64_t numbers = second;
    for (std::int64_t i = 0; i < first; ++i) {
      cursor_.enter("cell", i);
      const std::int64_t count = integer(kInt);
      if (count < 0 || count >= numbers) {
        throw cursor_.error(std::to_string(count) + " corners; the declared size has room for " +
                            std::to_string(std::max<std::int64_t>(numbers - 1, 0)));
      }
      numbers -= count + 1;
      for (std::int64_t c = 0; c < count; ++c) found.corners.push_back(index(kInt));
      found.ends.push_back(found.corners.size());
    }
    end_data();
    if (numbers != 0) {
      throw cursor_.error("the cells leave " + std::to_string(numbers) +
                          " of the declared numbers over");
    }
    return found;
  }

  Cells cells_of_arrays(std::int64_t offsets, std::int64_t connectivity) {
    const NumberType& offset_type = integer_type();
    const std::size_t place = cursor_.last_offset();
    check(place, offsets, least_bytes(offset_type), "offsets");
    begin_data();
    Cells found;
    std::int64_t last = 0;
    for (std::int64_t i = 0; i < offsets; ++i) {
      cursor_.enter("offset", i);
      const std::int64_t end = integer(offset_type);
      if (end < last || end > connectivity || (i == 0 && end != 0)) {
        throw cursor_.error(std::to_string(end) + " is no offset; they rise from 0 to " +
                            std::to_string(connectivity));
      }
      last = end;
      if (i > 0) found.ends.push_back(static_cast<std::size_t>(end));
    }
    end_data();
    if (last != connectivity) {
      throw cursor_.error("the last offset is " + std::to_string(last) + ", not the size " +
                          std::to_string(connectivity));
    }
    if (!cursor_.seek_word()) throw cursor_.truncated();
    if (keyword() != "connectivity") throw cursor_.error("'CONNECTIVITY' is needed");
    const NumberType& type = integer_type();
    check(cursor_.last_offset(), connectivity, least_bytes(type), "corners");
    begin_data();
    for (std::int64_t i = 0; i < connectivity; ++i) {
      cursor_.enter("corner", i);
      found.corners.push_back(index(type));
    }
    end_data();
    return found;
  }

  // Points and lines make no surface.
  void drop(const Cells& found) {
    for (std::size_t i = 0; i < found.ends.size(); ++i) drop_one(i);
    has_faces_ = true;
  }
  void drop_one(std::size_t cell) {
    mesh_.findings.add(Finding::dropped_element, static_cast<std::int64_t>(cell));
  }

  void polygons(const Cells& found) {
    for (std::size_t i = 0; i < found.ends.size(); ++i) polygon(found.cell(i));
    has_faces_ = true;
  }
  void polygon(std::span<const std::int32_t> corners) {
    for (const std::int32_t corner : corners) mesh_.corners.push_back(corner);
    mesh_.end_polygon();
  }

  void strips(const Cells& found) {
    for (std::size_t i = 0; i < found.ends.size(); ++i) strip(found.cell(i), i);
    has_faces_ = true;
  }
  // Every other triangle runs the other way round.
  void strip(std::span<const std::int32_t> corners, std::size_t cell) {
    if (corners.size() < 3) return drop_one(cell);
    for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
      const std::size_t odd = i % 2;
      polygon(std::array{corners[i + odd], corners[i + 1 - odd], corners[i + 2]});
    }
  }

  void cell_types() {
    if (has_faces_) throw cursor_.error("CELL_TYPES stand twice");
    const std::int64_t declared = cursor_.integer();
    if (std::cmp_not_equal(declared, grid_.ends.size())) {
      throw cursor_.error(std::to_string(declared) + " cell types for " +
                          std::to_string(grid_.ends.size()) + " cells");
    }
    check(cursor_.last_offset(), declared, least_bytes(kInt), "cell types");
    begin_data();
    for (std::size_t i = 0; i < grid_.ends.size(); ++i) {
      cursor_.enter("cell", static_cast<std::int64_t>(i));
      add_cell(integer(kInt), i);
    }
    end_data();
    has_faces_ = true;
  }

  void add_cell(std::int64_t type, std::size_t number) {
    constexpr std::int64_t kLastCurve = 4;  // from nothing over points to polygonal lines
    const auto corners = grid_.cell(number);
    const auto require = [&](std::size_t count) {
      if (corners.size() == count) return;
      throw cursor_.error(std::to_string(corners.size()) + " corners; a cell of type " +
                          std::to_string(type) + " has " + std::to_string(count));
    };
    if (type >= 0 && type <= kLastCurve) return drop_one(number);
    switch (type) {
      case 5:  // triangle
        require(3);
        return polygon(corners);
      case 6:
        return strip(corners, number);
      case 7:
        return polygon(corners);
      case 8:  // pixel: its last two corners stand the other way round
        require(4);
        return polygon(std::array{corners[0], corners[1], corners[3], corners[2]});
      case 9:  // quad
        require(4);
        return polygon(corners);
      default:
        throw cursor_.error("a cell of type " + std::to_string(type) +
                            " is a volume or curved; extract the surface as flat faces first");
    }
  }

  // Lines up to an empty one.
  void skip_metadata() {
    cursor_.skip_line();
    while (cursor_.left() > 0 && !cursor_.word().empty()) cursor_.skip_line();
  }

  void skip_field() {
    (void)cursor_.word();
    std::int64_t arrays = cursor_.checked_count(cursor_.integer(), 4, "arrays");
    for (; arrays > 0; --arrays) {
      cursor_.skip_line();
      if (!cursor_.seek_word()) throw cursor_.truncated();
      if (keyword() == "metadata") {
        skip_metadata();
        ++arrays;
        continue;
      }
      const std::int64_t components = cursor_.checked_count(cursor_.integer(), 1, "components");
      const std::int64_t tuples = cursor_.checked_count(cursor_.integer(), 1, "tuples");
      const NumberType& type = number_type();
      const auto tuple_bytes = static_cast<std::uint64_t>(components) * least_bytes(type);
      check(cursor_.last_offset(), tuples, std::max<std::uint64_t>(tuple_bytes, 1), "tuples");
      const std::int64_t values = components * tuples;  // no more than bytes are left
      begin_data();
      if (binary_) cursor_.take(static_cast<std::uint64_t>(values) * type.size);
      for (std::int64_t i = 0; !binary_ && i < values; ++i) {
        if (!cursor_.seek_word()) throw cursor_.truncated();
        (void)cursor_.word();
      }
      end_data();
    }
  }

  // What the two forms of a file share.

  std::string keyword() {
    std::string word(cursor_.word());
    for (char& c : word) {
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return word;
  }
  const NumberType& number_type() {
    const std::string name = keyword();
    for (const NumberType& type : kTypes) {
      if (type.name == name) return type;
    }
    throw cursor_.error(in_quotes(name) + " is no type of numbers");
  }
  const NumberType& integer_type() {
    const NumberType& type = number_type();
    if (type.real) throw cursor_.error("a type of integers is needed");
    return type;
  }
  [[nodiscard]] std::uint64_t least_bytes(const NumberType& type) const {
    return binary_ ? type.size : 2;
  }
  void check(std::size_t place, std::int64_t count, std::uint64_t bytes, const char* what) const {
    if (count >= 0 && static_cast<std::uint64_t>(count) <= (cursor_.left() + 1) / bytes) return;
    throw cursor_.error_at(
        place, std::to_string(count) + " " + what + " are declared, which the file cannot hold");
  }
  // Binary data begin right after the line that declares them.
  void begin_data() {
    if (!binary_) return;
    cursor_.skip_line();
    cursor_.expect_binary();
  }
  void end_data() {
    cursor_.leave();
    if (binary_) cursor_.expect_text({});
  }
  double coordinate(const NumberType& type) {
    if (!binary_) {
      if (!cursor_.seek_word()) throw cursor_.truncated();
      return cursor_.number();
    }
    if (!type.real) return static_cast<double>(integer(type));
    const double value = type.size == 4 ? double{cursor_.value<float>(std::endian::big)}
                                        : cursor_.value<double>(std::endian::big);
    if (!std::isfinite(value)) throw cursor_.error("coordinate is not finite");
    return value;
  }
  std::int64_t integer(const NumberType& type) {
    if (!binary_) {
      if (!cursor_.seek_word()) throw cursor_.truncated();
      return cursor_.integer();
    }
    std::uint64_t bits = 0;
    const std::string_view bytes = cursor_.take(type.size);
    if (type.has_sign && (static_cast<unsigned char>(bytes[0]) & 0x80U) != 0) bits = ~bits;
    for (const char c : bytes) bits = bits << 8U | static_cast<unsigned char>(c);
    return static_cast<std::int64_t>(bits);
  }
  std::int32_t index(const NumberType& type) {
    return cursor_.checked_index(integer(type), mesh_.vertex_count());
  }
  static Error missing(const std::string& what) {
    return {ErrorKind::bad_input, "", "end of file", "truncated: " + what + " are missing"};
  }

  Cursor cursor_;
  PolygonMesh mesh_;
  Cells grid_;
  bool binary_ = false;
  bool is_grid_ = false;
  bool has_points_ = false;
  bool has_faces_ = false;
};

}  // namespace

PolygonMesh read_vtk(Cursor cursor) { return VtkReader(cursor).read(); }

}  // namespace timbre::detail
