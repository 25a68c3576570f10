#include "timbre/index/labels.h"

#include <gtest/gtest.h>

#include "timbre/analysis/core/error.h"
#include "timbre/tests/support/temporary_folder.h"

namespace timbre {
namespace {

TEST(ShapeNameOf, DropsFolderAndEndings) {
  EXPECT_EQ(shape_name_of("a/b/cat.ply"), "cat");
  EXPECT_EQ(shape_name_of("cat.off.gz"), "cat");
  EXPECT_EQ(shape_name_of("cat.1.off"), "cat.1");
  EXPECT_EQ(shape_name_of("cat"), "cat");
  EXPECT_EQ(shape_name_of(".ply"), ".ply");
  EXPECT_EQ(shape_name_of("folder/"), "");
}

TEST(Labels, AreFoundByFileThenByStem) {
  const TemporaryFolder folder;
  put_file(folder / "l", "a.off cat 7\r\n\n  sub/b.ply\tdog 8\nc ? 9\nd.off x 1\nd.ply y 1\n");
  const Labels labels(folder / "l", 2);
  EXPECT_EQ(labels.of("/else/a.off"), "cat");
  EXPECT_EQ(labels.of("a"), "cat");
  EXPECT_EQ(labels.of("b.obj"), "dog");
  EXPECT_EQ(labels.of("c.off"), "");
  EXPECT_EQ(labels.of("unknown"), "");
  EXPECT_EQ(labels.of("d.ply"), "y");
  EXPECT_EQ(labels.of("d"), "");  // two files disagree
  EXPECT_EQ(Labels(folder / "l", 3).of("a"), "7");
}

TEST(Labels, RefuseLinesThatMeanNothing) {
  const TemporaryFolder folder;
  put_file(folder / "short", "a.off cat\nb.off\n");
  put_file(folder / "twice", "a.off cat\na.off dog\n");
  const auto what = [&](const std::string& name) {
    try {
      (void)Labels(folder / name, 2);
    } catch (const Error& error) {
      return std::string(error.what()).substr((folder / name).size());
    }
    return std::string("no error");
  };
  EXPECT_EQ(what("short"), ": line 2: has 1 columns; the label is wanted in 2");
  EXPECT_EQ(what("twice"), ": line 2: labels a.off a second time");
  EXPECT_EQ(what("missing"), ": No such file or directory");
}

}  // namespace
}  // namespace timbre
