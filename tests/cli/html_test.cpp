#include "timbre/cli/report/html.h"

#include <gtest/gtest.h>

namespace timbre::cli {
namespace {

TEST(EscapeHtml, LeavesNothingThatMeansSomething) {
  EXPECT_EQ(escape_html("<b a=\"1\" c='2'>&amp;"),
            "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt;&amp;amp;");
}

TEST(EscapeHtml, KeepsUtf8AndReplacesWhatIsNone) {
  EXPECT_EQ(escape_html("\xc3\xa9 \xe2\x82\xac \xf0\x9f\x90\x98"),
            "\xc3\xa9 \xe2\x82\xac \xf0\x9f\x90\x98");
  const std::string none = "\xef\xbf\xbd";
  EXPECT_EQ(escape_html("a\xff<"), "a" + none + "&lt;");
  EXPECT_EQ(escape_html("\xe2\x82"), none + none);
  // Overlong, a surrogate, beyond the last code point, a control character.
  EXPECT_EQ(escape_html("\xc0\xaf"), none + none);
  EXPECT_EQ(escape_html("\xed\xa0\x80"), none + none + none);
  EXPECT_EQ(escape_html("\xf4\x90\x80\x80"), none + none + none + none);
  EXPECT_EQ(escape_html("a\x01"), "a" + none);
}

TEST(ToBase64, AgreesWithTheExamplesOfItsStandard) {
  EXPECT_EQ(to_base64(""), "");
  EXPECT_EQ(to_base64("f"), "Zg==");
  EXPECT_EQ(to_base64("fo"), "Zm8=");
  EXPECT_EQ(to_base64("foo"), "Zm9v");
  EXPECT_EQ(to_base64("foob"), "Zm9vYg==");
  EXPECT_EQ(to_base64("\xff\xfe\xfd"), "//79");
}

TEST(ShellWord, IsQuotedWhereItMustBe) {
  EXPECT_EQ(shell_word("a/b-1.ply"), "a/b-1.ply");
  EXPECT_EQ(shell_word(""), "''");
  EXPECT_EQ(shell_word("two words"), "'two words'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word("$(x)"), "'$(x)'");
}

TEST(Table, EscapesItsCells) {
  const std::string html = table("a & b", {{"<"}, {"n", true}}, {{{"'x'"}, {"1", true}}});
  EXPECT_NE(html.find("<caption>a &amp; b</caption>"), std::string::npos);
  EXPECT_NE(html.find("<th scope=\"row\">&#39;x&#39;</th><td class=\"number\">1</td>"),
            std::string::npos);
}

}  // namespace
}  // namespace timbre::cli
