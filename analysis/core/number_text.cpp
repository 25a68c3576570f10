#include "timbre/analysis/core/number_text.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <cstdlib>

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

// An exponent of up to three digits at `at`, which moves behind it; 0 if there is none.
int leading_exponent(std::string_view text, std::size_t& at) {
  if (at == text.size() || (text[at] != 'e' && text[at] != 'E')) return 0;
  std::size_t next = at + 1;
  const bool has_sign = next < text.size() && (text[next] == '-' || text[next] == '+');
  const bool is_negative = has_sign && text[next] == '-';
  if (has_sign) ++next;
  const std::size_t first = next;
  int exponent = 0;
  for (; next < text.size() && next < first + 3 && is_digit(text[next]); ++next) {
    exponent = 10 * exponent + (text[next] - '0');
  }
  if (next > first) at = next;
  return is_negative ? -exponent : exponent;
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

LeadingNumber leading_number(std::string_view text) {
  static_assert(FLT_EVAL_METHOD == 0, "one operation must round once, to double");
  static constexpr std::array<double, 23> kPowers = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                     1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                     1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  static constexpr std::array<std::uint64_t, 9> kIntegerPowers = {
      1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000};
  constexpr std::size_t kMostDigits = 19;  // 10^19 < 2^64
  constexpr std::uint64_t kMostExact = std::uint64_t{1} << 53U;

  const std::size_t begin = !text.empty() && (text[0] == '-' || text[0] == '+') ? 1 : 0;
  std::size_t at = begin;
  std::uint64_t digits = 0;
  const auto read_digits = [&] {
    const std::size_t first = at;
    for (bool more = true; more && at - first <= kMostDigits;) {
      const LeadingDigits next = leading_digits(text.substr(at));
      digits = digits * kIntegerPowers[next.length] + next.value;
      at += next.length;
      more = next.length == 8;
    }
    return at - first;
  };
  std::size_t count = read_digits();
  std::size_t decimals = 0;
  if (at < text.size() && text[at] == '.') {
    ++at;
    decimals = read_digits();
    count += decimals;
  }
  if (count == 0 || count > kMostDigits || digits > kMostExact) return {};
  const int power = leading_exponent(text, at) - static_cast<int>(decimals);
  const auto size = static_cast<std::size_t>(std::abs(power));
  if (size >= kPowers.size()) return {};
  const auto whole = static_cast<double>(digits);
  const double value = power < 0 ? whole / kPowers[size] : whole * kPowers[size];
  return {text[0] == '-' ? -value : value, at};
}

std::optional<double> parse_double(std::string_view token) {
  if (const auto [value, length] = leading_number(token); length > 0 && length == token.size()) {
    return value;
  }
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
