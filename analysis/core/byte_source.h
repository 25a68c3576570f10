#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace timbre {

struct ByteSourceOptions {
  std::uint64_t size_limit = std::uint64_t{4} << 30;  ///< bytes; more are refused
  /// Sees the first bytes (at most 4 KiB) and the size of the file before the rest is
  /// read, and throws if they cannot begin anything useful. Not called for standard input.
  std::function<void(std::string_view head, std::uint64_t size)> inspect = {};
  /// Asked ten times a second while bytes are awaited; true ends the wait. May be empty.
  std::function<bool()> stop = {};
};

/// All bytes of a regular file (links are followed), or of standard input for `-`.
///
/// Never waits for a FIFO or a device: whatever is no regular file is refused. The file
/// is copied, not mapped, so one that shrinks meanwhile is merely shorter.
/// @throws Error  io with the system's words; bad_input beyond the limit; cancelled when `stop`
///                asks for it; what `inspect` throws
[[nodiscard]] std::string read_bytes(const std::string& path,
                                     const ByteSourceOptions& options = {});

/// Unpacks gzip data of one or more members.
///
/// @param size_limit  bytes of the result; besides, a result beyond 64 MiB and beyond 200
///                    times its packed size is taken for a bomb
/// @throws Error  bad_input for anything but whole members with the right checksums
[[nodiscard]] std::string unpack_gzip(std::string_view packed, std::uint64_t size_limit);

/// Whether the bytes begin as gzip data does.
[[nodiscard]] bool is_gzip(std::string_view bytes);

}  // namespace timbre
