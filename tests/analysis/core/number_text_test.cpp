#include "timbre/analysis/core/number_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <random>
#include <string>

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
