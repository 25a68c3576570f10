#include "timbre/analysis/core/byte_source.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <filesystem>

#include "timbre/analysis/core/error.h"
#include "timbre/tests/support/temporary_folder.h"

namespace timbre {
namespace {

template <typename Work>
std::string failure(Work work) {
  try {
    (void)work();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

std::string gzip(const std::string& content) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, 16 + MAX_WBITS, 9, Z_DEFAULT_STRATEGY), Z_OK);
  std::string packed(deflateBound(&stream, content.size()) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

constexpr std::uint64_t kLimit = std::uint64_t{1} << 30;

TEST(ReadBytes, ReadsFilesOfEverySizeAroundItsChunks) {
  const TemporaryFolder folder;
  for (const std::size_t size :
       {0U, 1U, 4095U, 4096U, 4097U, (1U << 20) + 4096U, (3U << 20) + 1U}) {
    std::string content(size, 'a');
    if (size > 0) content.back() = 'z';
    put_file(folder / "a", content);
    EXPECT_EQ(read_bytes(folder / "a"), content);
  }
}

TEST(ReadBytes, FollowsLinks) {
  const TemporaryFolder folder;
  put_file(folder / "a", "x");
  std::filesystem::create_symlink(folder / "a", folder / "b");
  EXPECT_EQ(read_bytes(folder / "b"), "x");
}

TEST(ReadBytes, RefusesWhatIsNoRegularFileWithoutWaiting) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "fifo").c_str(), 0600), 0);
  std::filesystem::create_symlink(folder / "loop", folder / "loop");
  EXPECT_EQ(failure([&] { return read_bytes(folder / "fifo"); }),
            folder / "fifo" + ": open: not a regular file");
  EXPECT_EQ(failure([&] { return read_bytes(folder.path().string()); }),
            folder.path().string() + ": open: not a regular file");
  EXPECT_EQ(failure([&] { return read_bytes("/dev/zero"); }),
            "/dev/zero: open: not a regular file");
  EXPECT_EQ(failure([&] { return read_bytes(folder / "none"); }),
            folder / "none" + ": open: No such file or directory");
  EXPECT_EQ(failure([&] { return read_bytes(folder / "loop"); }),
            folder / "loop" + ": open: Too many levels of symbolic links");
}

TEST(ReadBytes, HoldsTheLimit) {
  const TemporaryFolder folder;
  put_file(folder / "a", std::string(100, 'a'));
  EXPECT_EQ(read_bytes(folder / "a", {.size_limit = 100}).size(), 100U);
  EXPECT_EQ(failure([&] { return read_bytes(folder / "a", {.size_limit = 99}); }),
            folder / "a" + ": size: larger than the limit of 99 bytes");
}

TEST(ReadBytes, ShowsTheHeadBeforeItReadsTheRest) {
  const TemporaryFolder folder;
  put_file(folder / "sparse", "head");
  std::filesystem::resize_file(folder / "sparse", std::uintmax_t{3} << 30);
  const auto inspect = [](std::string_view head, std::uint64_t size) {
    EXPECT_EQ(head.size(), 4096U);
    EXPECT_EQ(head.substr(0, 4), "head");
    EXPECT_EQ(size, std::uint64_t{3} << 30);
    throw Error(ErrorKind::bad_input, "", "byte 4", "enough");
  };
  EXPECT_EQ(failure([&] { return read_bytes(folder / "sparse", {.inspect = inspect}); }),
            "byte 4: enough");
}

TEST(ReadBytes, NamesAnEmptyName) {
  EXPECT_EQ(failure([] { return read_bytes(""); }), "'': open: No such file or directory");
}

TEST(ReadBytes, StopsWaitingWhenAsked) {
  const TemporaryFolder folder;
  put_file(folder / "a", "x");
  EXPECT_EQ(read_bytes(folder / "a", {.stop = [] { return false; }}), "x");
  EXPECT_EQ(failure([&] { return read_bytes(folder / "a", {.stop = [] { return true; }}); }),
            folder / "a" + ": read: stopped on request");
}

TEST(UnpackGzip, JoinsMembers) {
  const std::string large(5'000'000, 'x');
  EXPECT_EQ(unpack_gzip(gzip("ab") + gzip("") + gzip(large), kLimit), "ab" + large);
}

// Space made and filled anew for each of them took long here.
TEST(UnpackGzip, TakesAsManyMembersAsThereAre) {
  std::string packed;
  const std::string member = gzip("ab");
  for (int i = 0; i < 100000; ++i) packed += member;
  EXPECT_EQ(unpack_gzip(packed, kLimit).size(), 200000U);
}

TEST(UnpackGzip, RefusesDamage) {
  const std::string packed = gzip("some content that is long enough to be cut");
  for (std::size_t size = 0; size < packed.size(); ++size) {
    EXPECT_EQ(failure([&] { return unpack_gzip(packed.substr(0, size), kLimit); }),
              "gzip: truncated");
  }
  std::string wrong = packed;
  wrong[packed.size() - 6] ^= 1;
  EXPECT_EQ(failure([&] { return unpack_gzip(wrong, kLimit); }), "gzip: incorrect data check");
  EXPECT_EQ(failure([&] { return unpack_gzip("plain text", kLimit); }),
            "gzip: incorrect header check");
  EXPECT_EQ(failure([&] { return unpack_gzip(packed + "junk after it", kLimit); }),
            "gzip: incorrect header check");
}

TEST(UnpackGzip, RefusesBombsButNotSmallContentOfAnyRatio) {
  EXPECT_EQ(unpack_gzip(gzip(std::string(60U << 20, ' ')), kLimit).size(), 60U << 20);
  EXPECT_EQ(failure([] { return unpack_gzip(gzip(std::string(100U << 20, ' ')), kLimit); }),
            "gzip: expands beyond the limit of 67108864 bytes");
  EXPECT_EQ(failure([] { return unpack_gzip(gzip(std::string(1000, ' ')), 999); }),
            "gzip: expands beyond the limit of 999 bytes");
}

}  // namespace
}  // namespace timbre
