#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace timbre::detail {

/// The words of one line that is not empty.
struct WordLine {
  std::int64_t number = 0;  ///< of the line, from 1
  std::vector<std::string> words;
};

/// A small text file, line by line; words are parted by blanks, tabs and commas.
/// @throws Error  io
[[nodiscard]] std::vector<WordLine> read_word_lines(const std::string& path);

}  // namespace timbre::detail
