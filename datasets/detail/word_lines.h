#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace timbre::detail {

/// A text file, line by line; words are parted by blanks, tabs and commas. Only the bytes of
/// the file are kept, not its words.
class WordLines {
 public:
  /// @throws Error  io
  explicit WordLines(std::string path);
  WordLines(const WordLines&) = delete;
  WordLines& operator=(const WordLines&) = delete;

  /// Goes to the next line that is not empty; false at the end.
  /// @throws Error  bad_input for a line of more than 1000 words
  bool next();

  /// Of the line `next` went to.
  [[nodiscard]] const std::vector<std::string_view>& words() const { return words_; }
  [[nodiscard]] std::string word(std::size_t column) const { return std::string(words_[column]); }
  [[nodiscard]] const std::string& path() const { return path_; }

  /// @throws Error  bad_input, with file and line
  [[noreturn]] void refuse(const std::string& cause) const;

 private:
  std::string path_, text_;
  std::size_t begin_ = 0;  // of the line after this one
  std::int64_t number_ = 0;
  std::vector<std::string_view> words_;
};

}  // namespace timbre::detail
