#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace timbre {

using Sha256Digest = std::array<std::uint8_t, 32>;

/// SHA-256 over pieces. Text pieces are preceded by their length, so that
/// ("ab", "c") and ("a", "bc") differ.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void add_bytes(std::span<const std::byte> bytes);
  void add_text(std::string_view text);
  [[nodiscard]] Sha256Digest finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

[[nodiscard]] std::string to_hex(const Sha256Digest& digest);

}  // namespace timbre
