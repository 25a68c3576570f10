#include "timbre/analysis/core/number_text.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace timbre {
namespace {

constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

// from_chars takes no '+', and a second sign after one must stay an error.
std::string_view without_plus(std::string_view token) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '+' && token[1] != '-') {
    token.remove_prefix(1);
  }
  return token;
}

// from_chars reports overflow and underflow alike. The place of the first
// non-zero digit, moved by the exponent, tells which of the two it was.
bool is_tiny(std::string_view number) {
  std::int64_t place = 0;
  bool seen_point = false;
  bool seen_digit = false;
  std::size_t i = number[0] == '-' ? 1 : 0;
  for (; i < number.size() && number[i] != 'e' && number[i] != 'E'; ++i) {
    if (number[i] == '.') {
      seen_point = true;
    } else if (seen_digit || number[i] != '0') {
      seen_digit = true;
      if (!seen_point) ++place;
    } else if (seen_point) {
      --place;
    }
  }
  if (i == number.size()) return place < 0;
  std::string_view exponent = without_plus(number.substr(i + 1));
  std::int64_t power = 0;
  const auto [end, error] =
      std::from_chars(exponent.data(), exponent.data() + exponent.size(), power);
  if (error == std::errc::result_out_of_range) return exponent[0] == '-';
  return power < -place;  // their sum may be beyond 64 bits
}

}  // namespace

std::string to_text(double value) {
  std::array<char, 32> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), end};
}

std::string to_text(double value, int digits) {
  if (std::abs(value) > 1e15) return to_text(value);
  std::array<char, 64> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                          std::chars_format::fixed, digits);
  return {buffer.data(), end};
}

std::string to_short_text(double value, int digits) {
  std::array<char, 64> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                          std::chars_format::general, digits);
  return {buffer.data(), end};
}

std::optional<double> parse_double(std::string_view token) {
  token = without_plus(token);
  const std::string_view digits = token.substr(!token.empty() && token[0] == '-' ? 1 : 0);
  // Rules out nan, inf and a lone sign, which from_chars would take or misread.
  if (digits.empty() || (!is_digit(digits[0]) && digits[0] != '.')) return std::nullopt;
  double value = 0.0;
  const char* const last = token.data() + token.size();
  const auto [end, error] = std::from_chars(token.data(), last, value);
  if (end != last || error == std::errc::invalid_argument) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    if (!is_tiny(token)) return std::nullopt;
    return token[0] == '-' ? -0.0 : 0.0;
  }
  return value;
}

std::optional<std::int64_t> parse_integer(std::string_view token) {
  token = without_plus(token);
  std::int64_t value = 0;
  const char* const last = token.data() + token.size();
  const auto [end, error] = std::from_chars(token.data(), last, value);
  if (end != last || error != std::errc() || token.empty()) return std::nullopt;
  return value;
}

}  // namespace timbre
