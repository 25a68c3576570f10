#pragma once

#include <charconv>
#include <cstdint>
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
