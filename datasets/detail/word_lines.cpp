#include "timbre/datasets/detail/word_lines.h"

#include <algorithm>
#include <utility>

#include "timbre/analysis/core/byte_source.h"
#include "timbre/analysis/core/error.h"

namespace timbre::detail {

WordLines::WordLines(std::string path) : path_(std::move(path)), text_(read_bytes(path_)) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text_.starts_with(kByteOrderMark)) begin_ = kByteOrderMark.size();
}

bool WordLines::next() {
  constexpr std::string_view kBlanks = " \t\r,\v\f";
  constexpr std::size_t kMostWords = 1000;
  words_.clear();
  while (words_.empty() && begin_ < text_.size()) {
    const std::size_t end = std::min(text_.find('\n', begin_), text_.size());
    const std::string_view line = std::string_view(text_).substr(begin_, end - begin_);
    begin_ = end + 1;
    ++number_;
    for (std::size_t at = line.find_first_not_of(kBlanks); at != std::string_view::npos;) {
      if (words_.size() == kMostWords) {
        refuse("has more than " + std::to_string(kMostWords) + " words");
      }
      const std::size_t stop = std::min(line.find_first_of(kBlanks, at), line.size());
      words_.push_back(line.substr(at, stop - at));
      at = line.find_first_not_of(kBlanks, stop);
    }
  }
  return !words_.empty();
}

void WordLines::refuse(const std::string& cause) const {
  throw Error(ErrorKind::bad_input, path_, "line " + std::to_string(number_), cause);
}

}  // namespace timbre::detail
