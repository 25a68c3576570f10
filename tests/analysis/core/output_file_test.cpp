#include "timbre/analysis/core/output_file.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "timbre/analysis/core/error.h"
#include "timbre/tests/support/temporary_folder.h"

namespace timbre {
namespace {

ErrorKind kind_of_failure(const std::string& path, bool overwrite) {
  try {
    write_file(path, "new", overwrite);
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), path);
    return error.kind();
  }
  ADD_FAILURE() << "no exception";
  return ErrorKind::cancelled;
}

TEST(WriteFile, LeavesTheContentAndNothingElse) {
  const TemporaryFolder folder;
  write_file(folder / "a.txt", "hello", false);
  EXPECT_EQ(file_content(folder / "a.txt"), "hello");
  write_file(folder / "a.txt", "again", true);
  EXPECT_EQ(file_content(folder / "a.txt"), "again");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(WriteFile, RefusesToReplaceUnlessToldTo) {
  const TemporaryFolder folder;
  put_file(folder / "a.txt", "old");
  EXPECT_EQ(kind_of_failure(folder / "a.txt", false), ErrorKind::bad_request);
  EXPECT_EQ(file_content(folder / "a.txt"), "old");
}

TEST(WriteFile, SaysWhatTheSystemSaid) {
  const TemporaryFolder folder;
  EXPECT_EQ(kind_of_failure(folder / "missing/a.txt", false), ErrorKind::io);
  EXPECT_EQ(kind_of_failure(folder.path().string(), true), ErrorKind::io);
}

}  // namespace
}  // namespace timbre
