#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "timbre/analysis/mesh/detail/cursor.h"

namespace timbre::detail {

enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

[[nodiscard]] std::size_t size_of(PlyType type);
[[nodiscard]] bool is_integer(PlyType type);
/// The largest value of an integer type.
[[nodiscard]] std::int64_t largest(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  std::optional<PlyType> length;  ///< type of the length, for a list
};

struct PlyElement {
  std::string name;
  std::int64_t count = 0;
  std::vector<PlyProperty> properties;

  /// The place of a property in `properties`; -1 if there is none of this name.
  [[nodiscard]] std::ptrdiff_t find(std::string_view property) const;
};

struct PlyHeader {
  std::optional<std::endian> binary;  ///< byte order; nothing for ascii
  std::vector<PlyElement> elements;   ///< in the order of the body
};

/// Reads the header and leaves the cursor at the body.
/// @throws Error  bad_input for all that is not PLY 1.0, or that describes no mesh in
///                vertices and faces, or that the bytes left cannot hold
[[nodiscard]] PlyHeader read_ply_header(Cursor& cursor);

}  // namespace timbre::detail
