#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

namespace timbre {

/// The shortest decimal text that reads back as the same double; no locale.
[[nodiscard]] std::string to_text(double value);

/// With a fixed number of digits after the point, for people; no locale.
[[nodiscard]] std::string to_text(double value, int digits);

/// With at most `digits` significant digits, for people; no locale.
[[nodiscard]] std::string to_short_text(double value, int digits = 4);

/// A whole token as a decimal number: `[+-]? digits [. digits] [e[+-]digits]`.
/// Too small rounds to 0 or a subnormal; too large, hexadecimal, `nan`, `inf`
/// and anything left over are no number.
[[nodiscard]] std::optional<double> parse_double(std::string_view token);

/// The digits at the front of a text, at most eight of them, and their value.
struct LeadingDigits {
  std::uint64_t value = 0;
  std::size_t length = 0;
};

/// Looks at eight characters at once: no branch depends on how many digits there are.
[[nodiscard]] inline LeadingDigits leading_digits(std::string_view text) {
  constexpr std::uint64_t kEach = 0x0101010101010101U;
  std::array<char, 8> chunk{};  // NUL is no digit
  if (text.size() >= chunk.size()) {
    std::memcpy(chunk.data(), text.data(), chunk.size());
  } else {
    text.copy(chunk.data(), text.size());
  }
  if constexpr (std::endian::native == std::endian::big) std::reverse(chunk.begin(), chunk.end());
  // The first character in the lowest byte. The topmost bit of a byte that is no digit is set;
  // what it carries into the next one comes after the end.
  const std::uint64_t bytes = std::bit_cast<std::uint64_t>(chunk) ^ (kEach * '0');
  const std::uint64_t others = ((bytes + kEach * 0x76U) | bytes) & (kEach * 0x80U);
  const auto length = static_cast<std::size_t>(std::countr_zero(others)) / 8;
  if (length == 0) return {};
  // Zeros in front make them eight; then pairs, pairs of pairs, and both halves are joined.
  std::uint64_t value = bytes << (8 * (chunk.size() - length));
  value = 10 * value + (value >> 8U);
  constexpr std::uint64_t kPairs = 0x000000ff000000ffU;
  value = (value & kPairs) * (100 + (std::uint64_t{1000000} << 32U)) +
          ((value >> 16U) & kPairs) * (1 + (std::uint64_t{10000} << 32U));
  return {value >> 32U, length};
}

/// A number at the front of a text, and how many characters it takes; 0 for none.
struct LeadingNumber {
  double value = 0.0;
  std::size_t length = 0;
};

/// The fast part of `parse_double`: of at most 19 digits, when their value and the power of
/// ten are both exact doubles, so that one multiplication or division rounds correctly (Clinger
/// 1990, section 3). All others are left to `parse_double`, and the length is 0.
[[nodiscard]] LeadingNumber leading_number(std::string_view text);

/// A whole token as a decimal integer with an optional sign.
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view token);

}  // namespace timbre
