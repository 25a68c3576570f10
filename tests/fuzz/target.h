#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "timbre/analysis/core/error.h"

namespace timbre::fuzz {

/// Puts one input through the code under test and holds it to its promises. Each target
/// defines it; an exception that leaves it is a finding.
void examine(std::string_view input);

/// Ends the process with the words unless the promise is kept.
inline void require(bool kept, const char* promise) {
  if (kept) return;
  std::fprintf(stderr, "broken promise: %s\n", promise);
  std::abort();
}

/// What every error is, whatever the input: of this kind, and one line of modest length.
inline void require_plain(const Error& error, ErrorKind kind) {
  constexpr std::string_view kControl("\0\a\b\t\n\v\f\r\x1b\x7f", 10);
  const std::string_view line = error.what();
  require(error.kind() == kind, "errors have the kind of their cause");
  require(line.find_first_of(kControl) == std::string_view::npos, "an error is one line");
  require(!error.cause().empty(), "an error says why");
  require(line.size() < 1000, "an error is short, however long the input");
}

/// Hands out the input as numbers, from the front; zeros when it is used up.
class Draw {
 public:
  explicit Draw(std::string_view input) : rest_(input) {}

  [[nodiscard]] bool empty() const { return rest_.empty(); }
  [[nodiscard]] std::string_view rest() const { return rest_; }

  template <typename T>
  T take() {
    T value{};
    const std::size_t size = rest_.size() < sizeof(T) ? rest_.size() : sizeof(T);
    std::memcpy(&value, rest_.data(), size);
    rest_.remove_prefix(size);
    return value;
  }

  /// In [0, count), count > 0.
  std::size_t below(std::size_t count) { return take<std::uint8_t>() % count; }

 private:
  std::string_view rest_;
};

}  // namespace timbre::fuzz
