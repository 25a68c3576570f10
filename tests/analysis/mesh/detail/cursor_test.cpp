#include "timbre/analysis/mesh/detail/cursor.h"

#include <gtest/gtest.h>

#include <vector>

namespace timbre::detail {
namespace {

std::vector<std::vector<std::string>> lines(const std::string& text, const TextRules& rules) {
  std::vector<std::vector<std::string>> all;
  Cursor cursor(text);
  cursor.expect_text(rules);
  while (cursor.seek_word()) {
    auto& line = all.emplace_back();
    for (auto word = cursor.word(); !word.empty(); word = cursor.word()) line.emplace_back(word);
  }
  return all;
}

using Lines = std::vector<std::vector<std::string>>;

TEST(Cursor, SplitsLinesAndWords) {
  EXPECT_EQ(lines("a b\r\n\n c\rd\t#e\v\f", {}), (Lines{{"a", "b"}, {"c"}, {"d", "#e"}}));
  EXPECT_EQ(lines("a#b\n#c\nd", {.hash_comments = true}), (Lines{{"a"}, {"d"}}));
  EXPECT_EQ(lines("", {}), Lines{});
  EXPECT_EQ(lines(" \n ", {}), Lines{});
}

TEST(Cursor, JoinsContinuedLinesOnlyWhereTheFormatDoes) {
  const TextRules obj = {.hash_comments = true, .continuation = true};
  EXPECT_EQ(lines("a\\\nb \\ \r\n c\\d \\e\\", obj), (Lines{{"a", "b", "c\\d", "\\e"}}));
  EXPECT_EQ(lines("a \\\nb", {}), (Lines{{"a", "\\"}, {"b"}}));
  EXPECT_EQ(lines("\\\n\\\n", obj), Lines{});
}

TEST(Cursor, NamesLineOrByteAndElement) {
  Cursor cursor("a\r\nb\rc\n\nd");
  cursor.expect_text({});
  while (cursor.seek_word() && cursor.word() != "d") {
  }
  EXPECT_STREQ(cursor.error("why").what(), "line 5: why");
  cursor.enter("face", 3);
  EXPECT_STREQ(cursor.error("why").what(), "line 5, face 3: why");
  EXPECT_STREQ(cursor.truncated().what(), "end of file: truncated: face 3 is missing");
  cursor.leave();
  cursor.expect_binary();
  EXPECT_STREQ(cursor.error("why").what(), "byte 8: why");
  EXPECT_STREQ(cursor.error_at(2, "why").what(), "byte 2: why");
}

TEST(Cursor, NeverLeavesTheBuffer) {
  Cursor cursor("abc");
  EXPECT_THROW((void)cursor.value<std::int32_t>(std::endian::little), Error);
  EXPECT_THROW((void)cursor.take(~std::uint64_t{0}), Error);
  EXPECT_EQ(cursor.take(3), "abc");
  EXPECT_EQ(cursor.left(), 0U);
  EXPECT_EQ(cursor.word(), "");
  cursor.skip_line();
  EXPECT_EQ(cursor.left(), 0U);
}

TEST(Cursor, ReadsValuesInBothOrders) {
  EXPECT_EQ(Cursor(std::string_view("\x01\x02", 2)).value<std::uint16_t>(std::endian::little), 513);
  EXPECT_EQ(Cursor(std::string_view("\x01\x02", 2)).value<std::uint16_t>(std::endian::big), 258);
}

TEST(Cursor, ChecksCountsBeforeAnyoneAllocates) {
  const Cursor cursor("123456");
  EXPECT_EQ(cursor.checked_count(3, 2, "pairs"), 3);
  EXPECT_EQ(cursor.checked_count(1, 7, "lines"), 1) << "the last line may lack its end";
  EXPECT_THROW((void)cursor.checked_count(4, 2, "pairs"), Error);
  EXPECT_THROW((void)cursor.checked_count(-1, 2, "pairs"), Error);
  EXPECT_THROW((void)cursor.checked_count(std::numeric_limits<std::int64_t>::max(), 2, "p"), Error);
}

TEST(InQuotes, CutsLongInputBetweenCharacters) {
  EXPECT_EQ(in_quotes("abc"), "'abc'");
  EXPECT_EQ(in_quotes(std::string(50, 'a')), "'" + std::string(40, 'a') + "...'");
  EXPECT_EQ(in_quotes(std::string(39, 'a') + "\xc3\xbc\xc3\xbc"),
            "'" + std::string(39, 'a') + "...'");
}

}  // namespace
}  // namespace timbre::detail
