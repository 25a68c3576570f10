// Numbers as text: `parse_double` and `parse_integer` against the grammar and strtod.
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <optional>
#include <string>

#include "timbre/analysis/core/number_text.h"
#include "timbre/analysis/mesh/detail/cursor.h"
#include "timbre/tests/fuzz/target.h"

namespace timbre::fuzz {
namespace {

std::size_t digits_at(std::string_view text, std::size_t at) {
  const std::size_t end = std::min(text.find_first_not_of("0123456789", at), text.size());
  return end - std::min(at, end);
}

// [+-]? digits [. digits] [e[+-]digits], with a digit in the mantissa.
bool is_decimal(std::string_view text) {
  std::size_t at = text.starts_with('+') || text.starts_with('-') ? 1 : 0;
  std::size_t mantissa = digits_at(text, at);
  at += mantissa;
  if (text.substr(at).starts_with('.')) {
    const std::size_t fraction = digits_at(text, ++at);
    mantissa += fraction;
    at += fraction;
  }
  if (mantissa == 0) return false;
  if (at == text.size()) return true;
  if (text[at] != 'e' && text[at] != 'E') return false;
  ++at;
  if (text.substr(at).starts_with('+') || text.substr(at).starts_with('-')) ++at;
  return at < text.size() && at + digits_at(text, at) == text.size();
}

std::optional<double> expected_double(const std::string& text) {
  if (!is_decimal(text)) return std::nullopt;
  const double value = std::strtod(text.c_str(), nullptr);
  if (std::isinf(value)) return std::nullopt;
  return value;
}

std::optional<std::int64_t> expected_integer(const std::string& text) {
  const std::size_t start = text.starts_with('+') || text.starts_with('-') ? 1 : 0;
  if (start == text.size() || digits_at(text, start) != text.size() - start) return std::nullopt;
  errno = 0;
  const long long value = std::strtoll(text.c_str(), nullptr, 10);
  if (errno != 0) return std::nullopt;
  return value;
}

bool same(const std::optional<double>& a, const std::optional<double>& b) {
  return a.has_value() == b.has_value() &&
         (!a || std::bit_cast<std::uint64_t>(*a) == std::bit_cast<std::uint64_t>(*b));
}

template <typename Number, typename Read>
std::optional<Number> through_cursor(std::string_view text, Read read) {
  detail::Cursor cursor(text);
  cursor.expect_text({});
  try {
    return read(cursor);
  } catch (const Error& error) {
    require_plain(error, ErrorKind::bad_input);
    return std::nullopt;
  }
}

}  // namespace

void examine(std::string_view input) {
  const std::string text(input);
  const std::optional<double> number = expected_double(text);
  const std::optional<std::int64_t> integer = expected_integer(text);
  require(same(parse_double(text), number), "parse_double agrees with strtod");
  require(parse_integer(text) == integer, "parse_integer agrees with strtoll");
  if (number) require(same(parse_double(to_text(*number)), number), "to_text loses nothing");

  // A whole word: what ends one does not belong to a number.
  if (text.find_first_of(std::string_view(" \t\v\f\r\n\0", 7)) != std::string::npos) return;
  require(same(through_cursor<double>(text, [](auto& cursor) { return cursor.number(); }), number),
          "a cursor reads the same number");
  require(
      through_cursor<std::int64_t>(text, [](auto& cursor) { return cursor.integer(); }) == integer,
      "a cursor reads the same integer");
}

}  // namespace timbre::fuzz
