// Packed files: what is unpacked is what was packed, in any number of members, or one line.
#include <zlib.h>

#include <optional>
#include <string>

#include "timbre/analysis/core/byte_source.h"
#include "timbre/tests/fuzz/target.h"

namespace timbre::fuzz {
namespace {

std::string packed(std::string_view content, int level) {
  z_stream stream{};
  constexpr int kGzip = 16 + MAX_WBITS;
  require(deflateInit2(&stream, level, Z_DEFLATED, kGzip, 8, Z_DEFAULT_STRATEGY) == Z_OK,
          "zlib works");
  std::string bytes(deflateBound(&stream, static_cast<uLong>(content.size())), '\0');
  std::string source(content);
  stream.next_in = reinterpret_cast<Bytef*>(source.data());
  stream.avail_in = static_cast<uInt>(source.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(bytes.size());
  require(deflate(&stream, Z_FINISH) == Z_STREAM_END, "zlib works");
  bytes.resize(stream.total_out);
  deflateEnd(&stream);
  return bytes;
}

std::optional<std::string> unpacked(std::string_view bytes, std::uint64_t limit) {
  try {
    std::string content = unpack_gzip(bytes, limit);
    require(content.size() <= limit, "no more is unpacked than allowed");
    return content;
  } catch (const Error& error) {
    require_plain(error, ErrorKind::bad_input);
    return std::nullopt;
  }
}

}  // namespace

void examine(std::string_view input) {
  constexpr std::uint64_t kLimit = 1 << 20;
  (void)unpacked(input, kLimit);
  (void)unpacked("\x1f\x8b\x08" + std::string(7, '\0') + std::string(input), kLimit);

  // The same content in members, cut where the input says, then damaged likewise.
  Draw draw(input);
  const std::size_t members = 1 + draw.below(4);
  const int level = static_cast<int>(draw.below(10));
  const std::size_t damage = draw.take<std::uint16_t>();
  const std::string content(draw.rest());
  std::string bytes;
  for (std::size_t i = 0; i < members; ++i) {
    const std::size_t begin = content.size() * i / members;
    const std::size_t end = content.size() * (i + 1) / members;
    bytes += packed(std::string_view(content).substr(begin, end - begin), level);
  }
  require(unpacked(bytes, kLimit) == content, "what was packed is unpacked");
  require(unpacked(bytes, content.size()) == content, "a limit may be reached");
  if (!content.empty()) {
    require(!unpacked(bytes, content.size() - 1), "a limit holds");
  }
  require(!unpacked(std::string_view(bytes).substr(0, bytes.size() - 1), kLimit),
          "a member that is cut is refused");
  require(!unpacked(bytes + '\0', kLimit), "bytes behind the last member are refused");
  bytes[damage % bytes.size()] = static_cast<char>(bytes[damage % bytes.size()] ^ 0x10);
  (void)unpacked(bytes, kLimit);
}

}  // namespace timbre::fuzz
