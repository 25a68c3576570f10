#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>
#include <type_traits>
#include <vector>

#include "timbre/analysis/core/output_file.h"
#include "timbre/analysis/core/sha256.h"

namespace timbre::detail {

/// The file in which a long computation keeps where it stands: numbers of this machine, after a
/// line that names format and owner, and before a SHA-256 over all of it. Classes write and read
/// their part by one function, `exchange(file, part)`, for either direction.
class StateWriter {
 public:
  /// @param owner  what the state belongs to; a reader with another one refuses it
  /// @throws Error  io
  StateWriter(const std::string& path, const Sha256Digest& owner);

  void bytes(const void* data, std::size_t size);
  void expect(std::size_t) {}
  /// Gives the file its name. @throws Error  io
  void finish();

 private:
  OutputFile file_;
  Sha256 hash_;
};

class StateReader {
 public:
  /// @throws Error  io; bad_input if the file is of another format or owner
  StateReader(const std::string& path, const Sha256Digest& owner);

  /// @throws Error  bad_input if the file ends before
  void bytes(void* data, std::size_t size);
  /// @throws Error  bad_input if fewer bytes are left; to be asked before memory is taken for them
  void expect(std::size_t size) const;
  /// @throws Error  bad_input if the checksum is not that of what was read
  void finish();

 private:
  [[noreturn]] void fail(const std::string& cause) const;

  std::string path_;
  std::ifstream file_;
  std::size_t left_ = 0;
  Sha256 hash_;
};

/// A number, or a struct of numbers.
template <typename File, typename T>
void exchange_value(File& file, T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  file.bytes(&value, sizeof value);
}

template <typename File, typename T>
void exchange_vector(File& file, std::vector<T>& values) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::uint64_t size = values.size();
  exchange_value(file, size);
  file.expect(size);
  values.resize(size);
  file.bytes(values.data(), size * sizeof(T));
}

}  // namespace timbre::detail
