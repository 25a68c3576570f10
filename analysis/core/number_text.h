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

/// A whole token as a decimal integer with an optional sign.
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view token);

}  // namespace timbre
