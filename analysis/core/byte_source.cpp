#include "timbre/analysis/core/byte_source.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#define ZLIB_CONST
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <new>
#include <system_error>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/huge_pages.h"

namespace timbre {
namespace {

constexpr std::size_t kHead = 4096;
constexpr std::size_t kChunk = std::size_t{1} << 18;
constexpr std::size_t kPiece = std::size_t{1} << 16;  // of what is unpacked
constexpr std::uint64_t kBombSize = std::uint64_t{64} << 20;
constexpr std::uint64_t kBombRatio = 200;

[[noreturn]] void fail(const std::string& path, const char* doing) {
  throw Error(ErrorKind::io, path, doing, std::generic_category().message(errno));
}

[[noreturn]] void refuse_size(const std::string& path, std::uint64_t limit) {
  throw Error(ErrorKind::bad_input, path, "size",
              "larger than the limit of " + std::to_string(limit) + " bytes");
}

class Descriptor {
 public:
  explicit Descriptor(const std::string& path)
      : number_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
    if (number_ < 0) fail(path, "open");
  }
  ~Descriptor() { ::close(number_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_;
};

// Waits until there is something to read, so that a pipe nobody writes to can be left. A signal
// alone would not do: it may come just before read(), or to another thread.
void wait_for_bytes(int descriptor, const std::string& path, const std::function<bool()>& stop) {
  constexpr int kMilliseconds = 100;
  for (;;) {
    if (stop()) throw Error(ErrorKind::cancelled, path, "read", "stopped on request");
    pollfd wanted{descriptor, POLLIN, 0};
    const int ready = ::poll(&wanted, 1, kMilliseconds);
    if (ready > 0 || (ready < 0 && errno != EINTR)) return;
  }
}

// Appends up to `count` bytes; false when the end came before.
bool append(std::string& bytes, int descriptor, std::size_t count, const std::string& path,
            const ByteSourceOptions& options) {
  const std::size_t start = bytes.size();
  bytes.resize(start + count);
  std::size_t got = 0;
  while (got < count) {
    if (options.stop) wait_for_bytes(descriptor, path, options.stop);
    const ssize_t n = ::read(descriptor, bytes.data() + start + got, count - got);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(path, "read");
    if (n == 0) break;
    got += static_cast<std::size_t>(n);
  }
  bytes.resize(start + got);
  return got == count;
}

void append_all(std::string& bytes, int descriptor, const std::string& path,
                const ByteSourceOptions& options) {
  for (bool more = true; more;) {
    more = append(bytes, descriptor, kChunk, path, options);
    if (bytes.size() > options.size_limit) refuse_size(path, options.size_limit);
  }
}

std::string read_regular_file(const std::string& path, const ByteSourceOptions& options) {
  // An empty name would drop out of the line of the error.
  if (path.empty()) {
    throw Error(ErrorKind::io, "''", "open", std::generic_category().message(ENOENT));
  }
  const Descriptor file(path);
  struct stat status {};
  if (::fstat(file.number(), &status) != 0) fail(path, "open");
  if (!S_ISREG(status.st_mode)) {
    throw Error(ErrorKind::bad_input, path, "open", "not a regular file");
  }
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (size > options.size_limit) refuse_size(path, options.size_limit);
  std::string bytes;
  const bool more = append(bytes, file.number(), kHead, path, options);
  if (options.inspect) options.inspect(bytes, std::max<std::uint64_t>(size, bytes.size()));
  if (!more) return bytes;
  bytes.reserve(static_cast<std::size_t>(size) + kChunk);
  prefer_huge_pages(bytes.data() + bytes.size(), bytes.capacity() - bytes.size());
  append_all(bytes, file.number(), path, options);
  return bytes;
}

class Inflater {
 public:
  Inflater() {
    constexpr int kGzipWithLargestWindow = 16 + MAX_WBITS;
    if (inflateInit2(&stream_, kGzipWithLargestWindow) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  // Unpacks the member at the front of `packed`, which loses it, and appends the content.
  void unpack_member(std::string_view& packed, std::string& content, std::uint64_t limit) {
    if (inflateReset(&stream_) != Z_OK) throw std::bad_alloc();
    for (int state = Z_OK; state != Z_STREAM_END;) {
      stream_.next_in = reinterpret_cast<const Bytef*>(packed.data());
      stream_.avail_in = static_cast<uInt>(std::min(packed.size(), kChunk));
      stream_.next_out = reinterpret_cast<Bytef*>(piece_.data());
      stream_.avail_out = kPiece;
      const std::size_t offered = stream_.avail_in;
      state = inflate(&stream_, Z_NO_FLUSH);
      packed.remove_prefix(offered - stream_.avail_in);
      content.append(piece_.data(), kPiece - stream_.avail_out);
      if (content.size() > limit) {
        throw Error(ErrorKind::bad_input, "", "gzip",
                    "expands beyond the limit of " + std::to_string(limit) + " bytes");
      }
      if (state == Z_MEM_ERROR) throw std::bad_alloc();
      if (state == Z_BUF_ERROR) throw Error(ErrorKind::bad_input, "", "gzip", "truncated");
      if (state != Z_OK && state != Z_STREAM_END) {
        throw Error(ErrorKind::bad_input, "", "gzip",
                    stream_.msg != nullptr ? stream_.msg : "broken stream");
      }
    }
  }

 private:
  z_stream stream_{};
  // Of its own: space made in `content` would be filled anew for each member, however small.
  std::vector<char> piece_ = std::vector<char>(kPiece);
};

}  // namespace

std::string read_bytes(const std::string& path, const ByteSourceOptions& options) {
  if (path != "-") return read_regular_file(path, options);
  std::string bytes;
  append_all(bytes, STDIN_FILENO, path, options);
  return bytes;
}

std::string unpack_gzip(std::string_view packed, std::uint64_t size_limit) {
  const std::uint64_t limit = std::min(size_limit, std::max(kBombSize, kBombRatio * packed.size()));
  std::string content;
  Inflater inflater;
  do {
    inflater.unpack_member(packed, content, limit);
  } while (!packed.empty());
  return content;
}

bool is_gzip(std::string_view bytes) { return bytes.starts_with("\x1f\x8b"); }

}  // namespace timbre
