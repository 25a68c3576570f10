#include "timbre/analysis/core/error.h"

#include <gtest/gtest.h>

namespace timbre {
namespace {

TEST(ErrorTest, JoinsThePartsThatAreKnown) {
  EXPECT_STREQ(Error(ErrorKind::bad_input, "a.off", "line 3", "no number").what(),
               "a.off: line 3: no number");
  EXPECT_STREQ(Error(ErrorKind::bad_request, "", "count", "is 0").what(), "count: is 0");
}

TEST(ErrorTest, StaysOneLineWhateverTheNames) {
  const Error error(ErrorKind::io, "a\nb\x1b.off", "open", "no\tsuch file");
  EXPECT_STREQ(error.what(), "a\\nb\\x1b.off: open: no\\tsuch file");
  EXPECT_EQ(error.file(), "a\nb\x1b.off");
}

TEST(ErrorTest, TakesTheFileNameLater) {
  const Error error = Error(ErrorKind::bad_input, "", "face 2", "index 9").in_file("x.ply");
  EXPECT_STREQ(error.what(), "x.ply: face 2: index 9");
  EXPECT_EQ(error.kind(), ErrorKind::bad_input);
}

}  // namespace
}  // namespace timbre
