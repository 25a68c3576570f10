#include "timbre/analysis/mesh/detail/ply_header.h"

#include <algorithm>
#include <array>
#include <utility>

namespace timbre::detail {
namespace {

constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypes = {{
    {"char", PlyType::int8},
    {"int8", PlyType::int8},
    {"uchar", PlyType::uint8},
    {"uint8", PlyType::uint8},
    {"short", PlyType::int16},
    {"int16", PlyType::int16},
    {"ushort", PlyType::uint16},
    {"uint16", PlyType::uint16},
    {"int", PlyType::int32},
    {"int32", PlyType::int32},
    {"uint", PlyType::uint32},
    {"uint32", PlyType::uint32},
    {"float", PlyType::float32},
    {"float32", PlyType::float32},
    {"double", PlyType::float64},
    {"float64", PlyType::float64},
}};

PlyType read_type(Cursor& cursor) {
  const std::string_view word = cursor.word();
  for (const auto& [name, type] : kTypes) {
    if (word == name) return type;
  }
  throw cursor.error(in_quotes(word) +
                     " is no type of PLY; char, uchar, short, ushort, int, uint, "
                     "float and double are");
}

std::string read_name(Cursor& cursor) {
  const std::string_view word = cursor.word();
  if (word.empty()) throw cursor.error("a name is missing");
  return std::string(word);
}

void require_line_end(Cursor& cursor) {
  const std::string_view word = cursor.word();
  if (!word.empty()) throw cursor.error(in_quotes(word) + " is one word too many");
}

std::optional<std::endian> read_format(Cursor& cursor) {
  const std::string_view format = cursor.word();
  const std::string_view version = cursor.word();
  if (version != "1.0") throw cursor.error("version " + in_quotes(version) + "; only 1.0 is known");
  if (format == "ascii") return std::nullopt;
  if (format == "binary_little_endian") return std::endian::little;
  if (format == "binary_big_endian") return std::endian::big;
  throw cursor.error("format " + in_quotes(format) +
                     "; ascii, binary_little_endian and binary_big_endian are known");
}

PlyElement read_element(Cursor& cursor, const std::vector<PlyElement>& before) {
  PlyElement element;
  element.name = read_name(cursor);
  element.count = cursor.integer();
  if (element.count < 0) throw cursor.error("a count below 0");
  for (const PlyElement& other : before) {
    if (other.name == element.name) {
      throw cursor.error("element " + in_quotes(element.name) + " is declared twice");
    }
  }
  return element;
}

PlyProperty read_property(Cursor& cursor, const PlyElement& element) {
  PlyProperty property;
  Cursor ahead = cursor;
  if (ahead.word() == "list") {
    cursor = ahead;
    property.length = read_type(cursor);
    if (!is_integer(*property.length)) throw cursor.error("a list length must be an integer");
  }
  property.type = read_type(cursor);
  property.name = read_name(cursor);
  if (element.find(property.name) >= 0) {
    throw cursor.error("property " + in_quotes(property.name) + " is declared twice");
  }
  return property;
}

Error header_error(const std::string& cause) { return {ErrorKind::bad_input, "", "header", cause}; }

void require_indices(const PlyElement& face) {
  std::ptrdiff_t place = face.find("vertex_indices");
  if (place < 0) place = face.find("vertex_index");
  if (place >= 0) {
    const PlyProperty& list = face.properties[static_cast<std::size_t>(place)];
    if (list.length && is_integer(list.type)) return;
  }
  throw header_error("faces need a list of integers named vertex_indices or vertex_index");
}

void require_mesh(const PlyHeader& header) {
  bool has_vertices = false;
  for (const PlyElement& element : header.elements) {
    if (element.name == "tristrips") {
      throw header_error("faces held as tristrips are not read; write them as faces");
    }
    if (element.name == "face") require_indices(element);
    if (element.name != "vertex") continue;
    has_vertices = true;
    for (const char* name : {"x", "y", "z"}) {
      const std::ptrdiff_t place = element.find(name);
      if (place < 0 || element.properties[static_cast<std::size_t>(place)].length) {
        throw header_error("vertices need x, y and z, each one number");
      }
    }
  }
  if (!has_vertices) throw header_error("no element 'vertex'");
}

// Rows take at least one digit and a space for each value in ascii, in binary their fixed
// part and the lengths of their lists.
void require_room(const PlyHeader& header, const Cursor& cursor) {
  for (const PlyElement& element : header.elements) {
    std::uint64_t least = 0;
    for (const PlyProperty& property : element.properties) {
      least += header.binary ? size_of(property.length.value_or(property.type)) : 2;
    }
    if (element.count == 0) continue;
    if (least == 0)
      throw header_error("rows of " + in_quotes(element.name) + " have no properties");
    (void)cursor.checked_count(element.count, least,
                               ("rows of " + in_quotes(element.name)).c_str());
  }
}

}  // namespace

std::size_t size_of(PlyType type) {
  constexpr std::array<std::size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

bool is_integer(PlyType type) { return type != PlyType::float32 && type != PlyType::float64; }

std::int64_t largest(PlyType type) {
  const std::size_t bits = 8 * size_of(type);
  const bool is_signed = type == PlyType::int8 || type == PlyType::int16 || type == PlyType::int32;
  return (std::int64_t{1} << (is_signed ? bits - 1 : bits)) - 1;
}

std::ptrdiff_t PlyElement::find(std::string_view property) const {
  const auto at = std::find_if(properties.begin(), properties.end(),
                               [&](const PlyProperty& p) { return p.name == property; });
  return at == properties.end() ? -1 : at - properties.begin();
}

PlyHeader read_ply_header(Cursor& cursor) {
  cursor.expect_text({});
  cursor.word();  // "ply", which brought us here
  require_line_end(cursor);
  cursor.skip_line();
  PlyHeader header;
  bool has_format = false;
  for (;; cursor.skip_line()) {
    if (cursor.left() == 0) throw header_error("does not end; 'end_header' is missing");
    const std::string_view keyword = cursor.word();
    if (keyword == "comment" || keyword == "obj_info") continue;
    if (keyword == "end_header") break;
    if (keyword == "format" && !has_format) {
      header.binary = read_format(cursor);
      has_format = true;
    } else if (keyword == "element") {
      header.elements.push_back(read_element(cursor, header.elements));
    } else if (keyword == "property" && !header.elements.empty()) {
      PlyElement& element = header.elements.back();
      element.properties.push_back(read_property(cursor, element));
    } else {
      throw cursor.error(in_quotes(keyword) +
                         " is not expected here; format, element, property, "
                         "comment, obj_info and end_header make a header");
    }
    require_line_end(cursor);
  }
  require_line_end(cursor);
  cursor.skip_line();
  if (!has_format) throw header_error("no line 'format'");
  require_mesh(header);
  require_room(header, cursor);
  return header;
}

}  // namespace timbre::detail
