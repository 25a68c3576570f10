#include "timbre/analysis/core/number_text.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <string_view>

namespace timbre {
namespace {

TEST(ParseDouble, TakesEveryDecimalForm) {
  EXPECT_EQ(parse_double("1"), 1.0);
  EXPECT_EQ(parse_double("+1.5"), 1.5);
  EXPECT_EQ(parse_double("-.5"), -0.5);
  EXPECT_EQ(parse_double("5."), 5.0);
  EXPECT_EQ(parse_double("1e3"), 1000.0);
  EXPECT_EQ(parse_double("1E+3"), 1000.0);
  EXPECT_TRUE(std::signbit(*parse_double("-0")));
}

TEST(ParseDouble, RefusesWhatIsNoNumber) {
  for (const char* text :
       {"",    "+",    "-",     ".",    "e",   "1e",  "1e+", "0x1p3", "0,5", "1.2.3", "nan",
        "inf", "-inf", "1.0d0", "0.5f", "+-1", "++1", "--1", " 1",    "1 ",  "e5",    ".e1"}) {
    EXPECT_FALSE(parse_double(text)) << text;
  }
}

TEST(ParseDouble, TellsTooLargeFromTooSmall) {
  EXPECT_FALSE(parse_double("1e999"));
  EXPECT_FALSE(parse_double("-1e400"));
  EXPECT_FALSE(parse_double("1" + std::string(400, '0')));
  EXPECT_FALSE(parse_double("1e99999999999999999999"));
  EXPECT_FALSE(parse_double("1e9223372036854775807"));
  EXPECT_FALSE(parse_double("10e+9223372036854775807"));
  EXPECT_EQ(parse_double("0.01e-9223372036854775808"), 0.0);
  EXPECT_EQ(parse_double("1e-999"), 0.0);
  EXPECT_EQ(parse_double("0." + std::string(400, '0') + "1"), 0.0);
  EXPECT_EQ(parse_double("1e-99999999999999999999"), 0.0);
  EXPECT_EQ(parse_double("0e99999999999999999999").value_or(0.0), 0.0);
  EXPECT_EQ(parse_double("4.9e-324"), std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(parse_double("1" + std::string(400, '0') + "e-400"), 1.0);
}

TEST(ParseDouble, ReadsBackWhatToTextWrote) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 100000; ++i) {
    const auto bits = random();
    double value = 0.0;
    static_assert(sizeof bits == sizeof value);
    std::memcpy(&value, &bits, sizeof value);
    if (!std::isfinite(value)) continue;
    const std::string text = to_text(value);
    ASSERT_EQ(parse_double(text), value) << text;
    ASSERT_EQ(std::strtod(text.c_str(), nullptr), value) << text;
  }
}

// from_chars is right, but takes no '+' and does not tell overflow from underflow.
std::optional<double> by_from_chars(std::string_view token) {
  if (token.starts_with('+')) token.remove_prefix(1);
  const char* const last = token.data() + token.size();
  double value = 0.0;
  const auto [end, error] = std::from_chars(token.data(), last, value);
  if (end != last || error == std::errc::invalid_argument) return std::nullopt;
  if (error == std::errc()) return value;
  const double rounded = std::strtod(std::string(token).c_str(), nullptr);
  return std::isfinite(rounded) ? std::optional(rounded) : std::nullopt;
}

// Digits, a point, an exponent: each there or not, often wrong, often cut.
std::string random_number_text(std::mt19937_64& random) {
  const auto digits = [&](std::uint64_t most) {
    std::string text(random() % (most + 1), '0');
    const bool has_leading_zeros = random() % 4 == 0;
    for (std::size_t i = has_leading_zeros ? text.size() / 2 : 0; i < text.size(); ++i) {
      text[i] = static_cast<char>('0' + random() % 10);
    }
    return text;
  };
  const auto one_of = [&](std::initializer_list<const char*> choices) {
    return std::string(choices.begin()[random() % choices.size()]);
  };
  std::string text =
      one_of({"", "", "", "-", "+", "--", "+-"}) + digits(random() % 2 == 0 ? 4 : 25);
  if (random() % 4 > 0) text += "." + digits(random() % 2 == 0 ? 6 : 25);
  if (random() % 3 == 0) {
    text += one_of({"e", "E"}) + one_of({"", "-", "+", "-0", "+-"}) + digits(random() % 2 + 1);
  }
  if (random() % 50 == 0) text += one_of({"e308", "e-320", "e-400", "e400", ".", "x", "e", "f"});
  if (random() % 50 == 0 && !text.empty()) text.resize(random() % text.size());
  return text;
}

TEST(ParseDouble, GivesTheBitsOfFromCharsForEveryShapeOfText) {
  std::mt19937_64 random(11);
  int taken = 0;
  for (int i = 0; i < 300000; ++i) {
    const std::string text = random_number_text(random);
    const std::optional<double> value = parse_double(text);
    const bool has_two_signs = text.size() > 1 && text[0] == '+' && text[1] == '-';
    const auto expected = has_two_signs ? std::nullopt : by_from_chars(text);
    ASSERT_EQ(value.has_value(), expected.has_value()) << text;
    if (!value) continue;
    ASSERT_EQ(std::bit_cast<std::uint64_t>(*value), std::bit_cast<std::uint64_t>(*expected))
        << text;
    ++taken;
  }
  EXPECT_GT(taken, 100000);
}

TEST(LeadingDigits, StopAfterEightOrBeforeAnyOtherByte) {
  for (int other = 0; other < 256; ++other) {
    if (other >= '0' && other <= '9') continue;
    for (const std::string digits : {"", "7", "07", "980", "1234567", "00000009", "98765432"}) {
      for (const std::string after : {"", "9", "99999999", "\xff\x80\x2f\x3a"}) {
        const auto [value, length] = leading_digits(digits + static_cast<char>(other) + after);
        ASSERT_EQ(length, digits.size()) << other;
        ASSERT_EQ(value, digits.empty() ? 0 : std::stoull(digits)) << other;
      }
    }
  }
  EXPECT_EQ(leading_digits("").length, 0U);
  EXPECT_EQ(leading_digits("123").value, 123U);
  EXPECT_EQ(leading_digits("123456789").length, 8U);
  EXPECT_EQ(leading_digits("123456789").value, 12345678U);
}

TEST(LeadingNumber, StopsWhereTheNumberStopsAndLeavesHardOnesAlone) {
  const auto length = [](std::string_view text) { return leading_number(text).length; };
  EXPECT_EQ(length("1.25e2 x"), 6U);
  EXPECT_EQ(leading_number("1.25e2 x").value, 125.0);
  EXPECT_EQ(length("1e"), 1U);
  EXPECT_EQ(length("1e+"), 1U);
  EXPECT_EQ(length("5.x"), 2U);
  EXPECT_EQ(length("9007199254740992"), 16U);
  for (const char* text : {"", "-", ".", "e5", "x", "nan", "+-1", "9007199254740993", "1e23",
                           "0.00000000000000000001", "12345678901234567890"}) {
    EXPECT_EQ(length(text), 0U) << text;
  }
}

TEST(ParseInteger, IsStrictAndNeverWraps) {
  EXPECT_EQ(parse_integer("42"), 42);
  EXPECT_EQ(parse_integer("+7"), 7);
  EXPECT_EQ(parse_integer("-9223372036854775808"), std::numeric_limits<std::int64_t>::min());
  for (const char* text :
       {"", "+", "-", "3.0", "2e0", "0x10", "9223372036854775808", "1 ", "+-1"}) {
    EXPECT_FALSE(parse_integer(text)) << text;
  }
}

}  // namespace
}  // namespace timbre
