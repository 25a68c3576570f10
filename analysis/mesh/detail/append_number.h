#pragma once

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <string>

#include "timbre/analysis/core/error.h"

namespace timbre::detail {

/// The shortest text that is read back as the same number.
template <typename Number>
void append_text(std::string& out, Number value) {
  std::array<char, 32> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  out.append(buffer.data(), result.ptr);
}

/// The value's bytes, most significant first.
template <typename Number>
void append_big_endian(std::string& out, Number value) {
  static_assert(std::endian::native == std::endian::little);
  const auto raw = std::bit_cast<std::array<char, sizeof(Number)>>(value);
  out.append(raw.rbegin(), raw.rend());
}

/// The value's bytes, least significant first.
template <typename Number>
void append_little_endian(std::string& out, Number value) {
  static_assert(std::endian::native == std::endian::little);
  const auto raw = std::bit_cast<std::array<char, sizeof(Number)>>(value);
  out.append(raw.begin(), raw.end());
}

/// A coordinate, rounded. @throws Error  bad_request if it is beyond the range of a float
inline float to_float(double value) {
  const auto rounded = static_cast<float>(value);
  if (std::isfinite(rounded)) return rounded;
  throw Error(ErrorKind::bad_request, "", "output",
              "a coordinate is beyond the range of a float; .ply keeps it");
}

}  // namespace timbre::detail
