#pragma once

#include <cstddef>

namespace timbre::fuzz {

/// Sees how much memory is taken at once while it lives, where a sanitizer counts it;
/// elsewhere 0. One at a time.
class MemoryWatch {
 public:
  MemoryWatch();
  ~MemoryWatch();
  MemoryWatch(const MemoryWatch&) = delete;
  MemoryWatch& operator=(const MemoryWatch&) = delete;

  [[nodiscard]] std::size_t peak() const;
};

}  // namespace timbre::fuzz
