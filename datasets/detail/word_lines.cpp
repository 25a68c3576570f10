#include "timbre/datasets/detail/word_lines.h"

#include <string_view>

#include "timbre/analysis/core/byte_source.h"

namespace timbre::detail {

std::vector<WordLine> read_word_lines(const std::string& path) {
  constexpr std::string_view kBlanks = " \t\r,\v\f";
  const std::string text = read_bytes(path);
  std::vector<WordLine> lines;
  std::int64_t number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = std::string_view(text).substr(begin, end - begin);
    begin = end + 1;
    WordLine words{++number, {}};
    for (std::size_t at = line.find_first_not_of(kBlanks); at != std::string_view::npos;) {
      const std::size_t stop = std::min(line.find_first_of(kBlanks, at), line.size());
      words.words.emplace_back(line.substr(at, stop - at));
      at = line.find_first_not_of(kBlanks, stop);
    }
    if (!words.words.empty()) lines.push_back(std::move(words));
  }
  return lines;
}

}  // namespace timbre::detail
