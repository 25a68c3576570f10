#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "timbre/analysis/mesh/detail/formats.h"

namespace timbre::detail {

/// Reads points of three numbers each that lie one behind the other, up to the first that is
/// odd in any way: cut off, or not finite. The general reader goes on there, and knows what to
/// say; most often there is nothing left.
///
/// @return how many of `count` points were read
template <typename Number>
std::int64_t read_plain_points(Cursor& cursor, std::int64_t count, std::endian order,
                               PolygonMesh& mesh) {
  constexpr std::size_t kRow = 3 * sizeof(Number);
  const std::size_t rows = std::min(static_cast<std::size_t>(count), cursor.left() / kRow);
  const std::string_view bytes = cursor.rest();
  double* const xyz = mesh.coordinates.extend(3 * rows);
  std::size_t read = 0;
  for (; read < 3 * rows; ++read) {
    const auto value = value_of<Number>(bytes.substr(read * sizeof(Number)), order);
    if (!std::isfinite(value)) break;
    xyz[read] = value;
  }
  const std::size_t whole = read / 3;
  mesh.coordinates.shrink(3 * (rows - whole));
  cursor.take(whole * kRow);
  return static_cast<std::int64_t>(whole);
}

}  // namespace timbre::detail
