#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "timbre/analysis/mesh/read_mesh.h"

namespace timbre::detail {

/// What a reader may have to say about a file it read all the same; in the order of the codes.
enum class Finding : std::uint8_t {
  coincident_vertex,
  crude_split,
  degenerate_face,
  dropped_element,
  duplicate_face,
  extra_values,
  glued_header,
  ignored_data,
  no_faces,
  trailing_data,
  triangulated,
  unused_vertex,
  welded,
};
inline constexpr std::size_t kFindings = 13;

/// Counts findings and remembers the first few places of each.
class Findings {
 public:
  /// One more, about this vertex or face of the file.
  void add(Finding what, std::int64_t element);
  /// One more, about this word of the file.
  void add(Finding what, std::string_view word);
  /// So many more, or one, without a place.
  void add_count(Finding what, std::int64_t count = 1) { entry(what).count += count; }

  [[nodiscard]] std::int64_t count(Finding what) const {
    return entries_[static_cast<std::size_t>(what)].count;
  }
  /// What was found, sorted by code.
  [[nodiscard]] std::vector<ReadWarning> warnings() const;

 private:
  struct Entry {
    std::int64_t count = 0;
    std::vector<std::string> places;
  };
  Entry& entry(Finding what) { return entries_[static_cast<std::size_t>(what)]; }

  std::array<Entry, kFindings> entries_;
};

}  // namespace timbre::detail
