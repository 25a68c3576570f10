#include "timbre/analysis/spectrum/detail/state_file.h"

#include <filesystem>
#include <span>
#include <string_view>
#include <system_error>

#include "timbre/analysis/core/error.h"

namespace timbre::detail {
namespace {

// Structs are stored as they lie in memory: raise it with each change of theirs.
constexpr std::string_view kFormat = "timbre spectrum state, format 1\n";

std::span<const std::byte> as_span(const void* data, std::size_t size) {
  return {static_cast<const std::byte*>(data), size};
}

}  // namespace

StateWriter::StateWriter(const std::string& path, const Sha256Digest& owner) : file_(path, true) {
  bytes(kFormat.data(), kFormat.size());
  bytes(owner.data(), owner.size());
}

void StateWriter::bytes(const void* data, std::size_t size) {
  file_.write({static_cast<const char*>(data), size});
  hash_.add_bytes(as_span(data, size));
}

void StateWriter::finish() {
  const Sha256Digest digest = hash_.finish();
  file_.write({reinterpret_cast<const char*>(digest.data()), digest.size()});
  file_.commit();
}

StateReader::StateReader(const std::string& path, const Sha256Digest& owner)
    : path_(path), file_(path, std::ios::binary) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (!file_ || error) throw Error(ErrorKind::io, path, "", "cannot be read");
  left_ = static_cast<std::size_t>(size);
  std::string format(kFormat.size(), '\0');
  bytes(format.data(), format.size());
  if (format != kFormat) fail("is not a state that this version of timbre wrote");
  Sha256Digest found{};
  bytes(found.data(), found.size());
  if (found != owner) fail("belongs to another mesh or other options");
}

void StateReader::bytes(void* data, std::size_t size) {
  expect(size);
  file_.read(static_cast<char*>(data), static_cast<std::streamsize>(size));
  if (!file_) throw Error(ErrorKind::io, path_, "", "cannot be read");
  left_ -= size;
  hash_.add_bytes(as_span(data, size));
}

void StateReader::expect(std::size_t size) const {
  if (size > left_) fail("ends early");
}

void StateReader::finish() {
  const Sha256Digest digest = hash_.finish();
  Sha256Digest stored{};
  if (left_ != stored.size()) fail("is longer than it should be");
  file_.read(reinterpret_cast<char*>(stored.data()), static_cast<std::streamsize>(stored.size()));
  if (!file_ || stored != digest) fail("is damaged: its checksum is not that of its content");
}

void StateReader::fail(const std::string& cause) const {
  throw Error(ErrorKind::bad_input, path_, "", cause);
}

}  // namespace timbre::detail
