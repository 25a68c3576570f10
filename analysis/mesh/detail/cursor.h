#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"

namespace timbre::detail {

/// What the lines of a text format have beside words.
struct TextRules {
  bool hash_comments = false;  ///< `#` starts a comment, also in the middle of a word
  bool continuation = false;   ///< `\` at the end of a line continues it
};

/// Reads a buffer from front to back: words and lines of text, or binary values. All
/// accesses of the readers go through it and stay inside the buffer. Lines end with LF,
/// CRLF or CR. The place of an error is worked out when the error is made, not before.
class Cursor {
 public:
  explicit Cursor(std::string_view bytes) : bytes_(bytes) {}

  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }
  /// The bytes that are left, without moving.
  [[nodiscard]] std::string_view rest() const { return bytes_.substr(at_); }

  /// The bytes from the last word or value on.
  [[nodiscard]] std::string_view since_last() const { return bytes_.substr(last_); }

  // Text.

  void expect_text(const TextRules& rules);
  /// @throws Error  at the first NUL byte that is left
  void refuse_nul() const;
  /// The next word of this line; empty at the end of the line, which it does not leave.
  std::string_view word();
  /// Goes to the first word of this line or of a later one; false if there is none.
  bool seek_word();
  /// Leaves this line, whatever is still on it.
  void skip_line();
  /// How many words are still on this line; reads them.
  std::size_t count_words();
  /// The next word as a number. @throws Error  if it is none, or is missing
  double number();
  /// The next word as an integer. @throws Error  if it is none, or is missing
  std::int64_t integer();
  /// The next word if it is nothing but one to eight digits; otherwise it is still the next.
  std::optional<std::int64_t> plain_integer() {
    skip_blanks();
    const LeadingDigits lead = leading_digits(rest());
    if (lead.length == 0 || !is_word_end(at_ + lead.length)) return std::nullopt;
    last_ = at_;
    at_ += lead.length;
    return static_cast<std::int64_t>(lead.value);
  }
  /// The next word as a vertex number below `count`.
  std::int32_t vertex_index(std::int64_t count);

  // Binary.

  void expect_binary() { text_ = false; }
  /// The next `count` bytes. @throws Error  if fewer are left
  std::string_view take(std::uint64_t count) {
    last_ = at_;
    if (count > left()) throw too_short(count);
    at_ += static_cast<std::size_t>(count);
    return bytes_.substr(last_, static_cast<std::size_t>(count));
  }
  /// The next value, in the byte order given.
  template <typename T>
  T value(std::endian order);

  // Either.

  /// A count just read, once it is sure that the bytes left can hold so many elements.
  [[nodiscard]] std::int64_t checked_count(std::int64_t count, std::uint64_t least_bytes,
                                           const char* elements) const;
  /// A vertex number just read, once it is sure that it lies below `count`.
  [[nodiscard]] std::int32_t checked_index(std::int64_t index, std::int64_t count) const {
    if (index < 0 || index >= count) throw out_of_range(index, count);
    return static_cast<std::int32_t>(index);
  }

  // Errors.

  /// From now on errors name this element too: `line 12, vertex 5`.
  void enter(const char* kind, std::int64_t index) {
    element_ = kind;
    index_ = index;
  }
  /// Errors name only the place again.
  void leave() { element_ = nullptr; }
  /// An error where the last word or value began: its line in text, its byte in binary.
  [[nodiscard]] Error error(const std::string& cause) const;
  /// The same for a word or value read before, as `last_offset` gave it then.
  [[nodiscard]] Error error_at(std::size_t offset, const std::string& cause) const;
  [[nodiscard]] std::size_t last_offset() const { return last_; }
  /// The error for input that ends too soon.
  [[nodiscard]] Error truncated() const;

 private:
  [[nodiscard]] char now() const { return bytes_[at_]; }
  [[nodiscard]] Error too_short(std::uint64_t count) const;
  [[nodiscard]] Error out_of_range(std::int64_t index, std::int64_t count) const;
  /// Whether a word that goes up to `end` ends there for sure.
  [[nodiscard]] bool is_word_end(std::size_t end) const {
    if (end == bytes_.size()) return true;
    return ends_word_[static_cast<unsigned char>(bytes_[end])] && bytes_[end] != '\\';
  }
  [[nodiscard]] bool at_continuation(std::size_t& next_line) const;
  static constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
  void skip_blanks() {
    std::size_t at = at_;
    while (at < bytes_.size() && is_blank(bytes_[at])) ++at;
    at_ = at;
    if (at < bytes_.size() && bytes_[at] == '\\') skip_continuations();
  }
  void skip_continuations();
  void skip_line_end();

  std::string_view bytes_;
  std::size_t at_ = 0;
  std::size_t last_ = 0;
  const char* element_ = nullptr;
  std::int64_t index_ = 0;
  bool text_ = false;
  TextRules rules_;
  std::array<bool, 256> ends_word_{};
};

/// A piece of input for a message: at most 40 bytes, in quotes.
[[nodiscard]] std::string in_quotes(std::string_view input);

/// The value that `bytes` begin with; there are enough of them.
template <typename T>
T value_of(std::string_view bytes, std::endian order) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), bytes.data(), sizeof(T));
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

template <typename T>
T Cursor::value(std::endian order) {
  return value_of<T>(take(sizeof(T)), order);
}

}  // namespace timbre::detail
