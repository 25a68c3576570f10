#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "timbre/analysis/core/number_text.h"
#include "timbre/analysis/mesh/detail/formats.h"

namespace timbre::detail {
namespace {

// Statements that carry nothing timbre needs.
constexpr std::array<std::string_view, 9> kSkipped = {"vn", "vt", "vp",     "g",     "o",
                                                      "s",  "mg", "usemtl", "mtllib"};

// Texture coordinates and normals are not read, so exporters' NaN there does no harm.
bool is_number_or_nan(std::string_view word) {
  if (parse_double(word)) return true;
  if (!word.empty() && (word[0] == '+' || word[0] == '-')) word.remove_prefix(1);
  std::string start(word.substr(0, 3));
  for (char& c : start) c = static_cast<char>(c | 0x20);
  return start == "nan" || start == "inf";
}

// The texture or normal slot of a corner: an integer of any size, or nothing.
bool is_slot(std::string_view slot) {
  if (!slot.empty() && (slot[0] == '+' || slot[0] == '-')) {
    slot.remove_prefix(1);
    if (slot.empty()) return false;
  }
  return slot.find_first_not_of("0123456789") == std::string_view::npos;
}

class ObjReader {
 public:
  explicit ObjReader(const Cursor& cursor) : cursor_(cursor) {}

  PolygonMesh read() {
    while (cursor_.seek_word()) {
      statement(cursor_.word());
      cursor_.skip_line();
    }
    if (mesh_.vertex_count() == 0) {
      throw Error(ErrorKind::bad_input, "", "end of file", "no vertices ('v' lines)");
    }
    if (largest_index_ >= mesh_.vertex_count()) {
      throw cursor_.error_at(largest_offset_, out_of_range(largest_index_ + 1));
    }
    return std::move(mesh_);
  }

 private:
  void statement(std::string_view keyword) {
    if (keyword == "v") {
      vertex();
    } else if (keyword == "f") {
      face();
    } else if (keyword == "l" || keyword == "p") {
      mesh_.findings.add_count(Finding::dropped_element);
    } else if (std::find(kSkipped.begin(), kSkipped.end(), keyword) == kSkipped.end()) {
      mesh_.findings.add(Finding::ignored_data, keyword);
    }
  }

  void vertex() {
    const double x = cursor_.number();
    const double y = cursor_.number();
    const double z = cursor_.number();
    std::size_t values = 3;
    for (auto word = cursor_.word(); !word.empty(); word = cursor_.word()) {
      if (!is_number_or_nan(word)) throw cursor_.error(in_quotes(word) + " is not a number");
      ++values;
    }
    if (values == 5 || values > 7) {
      throw cursor_.error("a vertex of " + std::to_string(values) +
                          " values; 3, 4 (w), 6 (r g b) or 7 (r g b a) are known");
    }
    mesh_.add_vertex(x, y, z);
  }

  void face() {
    std::size_t corners = 0;
    for (;; ++corners) {
      if (const auto number = cursor_.plain_integer()) {
        mesh_.corners.push_back(index(*number));
        continue;
      }
      const std::string_view word = cursor_.word();
      if (word.empty()) break;
      mesh_.corners.push_back(corner(word));
    }
    if (corners == 0) throw cursor_.error("a face without corners");
    mesh_.end_polygon();
  }

  // v, v/t, v//n or v/t/n.
  std::int32_t corner(std::string_view word) {
    const LeadingDigits lead = leading_digits(cursor_.since_last());
    std::size_t slash = lead.length;
    std::optional<std::int64_t> number = static_cast<std::int64_t>(lead.value);
    if (lead.length == 0 || (lead.length < word.size() && word[lead.length] != '/')) {
      slash = std::min(word.find('/'), word.size());
      number = parse_integer(word.substr(0, slash));
    }
    if (number && are_slots(word.substr(slash))) return index(*number);
    throw cursor_.error(in_quotes(word) + " is not v, v/t, v//n or v/t/n in integers of 64 bits");
  }

  // Positive numbers may name a later vertex, negative ones count back from here.
  std::int32_t index(std::int64_t number) {
    const std::int64_t index = number > 0 ? number - 1 : mesh_.vertex_count() + number;
    constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
    if (number == 0 || index < 0 || index > kMost) throw cursor_.error(out_of_range(number));
    if (index > largest_index_) {
      largest_index_ = index;
      largest_offset_ = cursor_.last_offset();
    }
    return static_cast<std::int32_t>(index);
  }

  static bool are_slots(std::string_view slots) {
    if (slots.empty()) return true;
    slots.remove_prefix(1);
    const std::size_t slash = slots.find('/');
    if (slash == std::string_view::npos) return is_slot(slots);
    return is_slot(slots.substr(0, slash)) && is_slot(slots.substr(slash + 1));
  }

  [[nodiscard]] std::string out_of_range(std::int64_t number) const {
    if (number == 0) return "index 0; OBJ counts from 1";
    return "index " + std::to_string(number) + " is out of range; there are " +
           std::to_string(mesh_.vertex_count()) + " vertices";
  }

  Cursor cursor_;
  PolygonMesh mesh_;
  std::int64_t largest_index_ = -1;
  std::size_t largest_offset_ = 0;
};

}  // namespace

PolygonMesh read_obj(Cursor cursor) {
  cursor.expect_text({.hash_comments = true, .continuation = true});
  cursor.refuse_nul();
  return ObjReader(cursor).read();
}

}  // namespace timbre::detail
