#include "timbre/analysis/core/output_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

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

TEST(WriteFile, ReplacesTheFileBehindALinkAndKeepsItsMode) {
  namespace fs = std::filesystem;
  const TemporaryFolder folder;
  fs::create_directory(folder / "far");
  put_file(folder / "far/a.txt", "old");
  fs::permissions(folder / "far/a.txt", fs::perms::owner_all | fs::perms::others_write);
  fs::create_symlink("far/a.txt", folder / "link.txt");
  write_file(folder / "link.txt", "new", true);
  EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
  EXPECT_EQ(file_content(folder / "far/a.txt"), "new");
  EXPECT_EQ(fs::status(folder / "far/a.txt").permissions(),
            fs::perms::owner_all | fs::perms::others_write);
}

TEST(WriteFile, RefusesWhatIsNoRegularFile) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "fifo").c_str(), 0600), 0);
  std::filesystem::create_symlink("none", folder / "broken");
  for (const bool overwrite : {false, true}) {
    EXPECT_EQ(kind_of_failure(folder / "fifo", overwrite), ErrorKind::bad_request);
    EXPECT_EQ(kind_of_failure(folder / "broken", overwrite), ErrorKind::bad_request);
    EXPECT_EQ(kind_of_failure("/dev/null", overwrite), ErrorKind::bad_request);
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "none"));
}

TEST(OutputFile, AppearsWholeOrNotAtAll) {
  const TemporaryFolder folder;
  {
    OutputFile file(folder / "a.txt", false);
    file.write("never ");
    file.write("seen");
    EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 0);
  OutputFile file(folder / "a.txt", false);
  file.write("in ");
  file.write("pieces");
  file.commit();
  EXPECT_EQ(file_content(folder / "a.txt"), "in pieces");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(OutputFile, DoesNotReplaceAFileThatAppearedMeanwhile) {
  const TemporaryFolder folder;
  OutputFile file(folder / "a.txt", false);
  file.write("new");
  put_file(folder / "a.txt", "old");
  EXPECT_THROW(file.commit(), Error);
  EXPECT_EQ(file_content(folder / "a.txt"), "old");
}

TEST(RequireWritable, RefusesWhatWriteFileWouldAndWritesNothing) {
  const TemporaryFolder folder;
  require_writable(folder / "a.txt", false);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
  put_file(folder / "a.txt", "old");
  require_writable(folder / "a.txt", true);
  EXPECT_EQ(file_content(folder / "a.txt"), "old");
  EXPECT_THROW(require_writable(folder / "a.txt", false), Error);
  EXPECT_THROW(require_writable(folder / "none/a.txt", true), Error);
  EXPECT_THROW(require_writable(folder / "a.txt/b.txt", true), Error);
  EXPECT_THROW(require_writable(folder.path().string(), true), Error);
}

}  // namespace
}  // namespace timbre
