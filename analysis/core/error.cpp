#include "timbre/analysis/core/error.h"

#include <utility>

namespace timbre {

Error::Error(ErrorKind kind, std::string file, std::string place, std::string cause)
    : kind_(kind), file_(std::move(file)), place_(std::move(place)), cause_(std::move(cause)) {
  for (const std::string* part : {&file_, &place_, &cause_}) {
    if (part->empty()) continue;
    if (!line_.empty()) line_ += ": ";
    line_ += escape_control(*part);
  }
}

Error Error::in_file(std::string file) const { return {kind_, std::move(file), place_, cause_}; }

std::string escape_control(std::string_view text) {
  static constexpr char kHex[] = "0123456789abcdef";
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (byte < 0x20 || byte == 0x7f) {
      out += "\\x";
      out += kHex[byte >> 4];
      out += kHex[byte & 15];
    } else {
      out += c;
    }
  }
  return out;
}

}  // namespace timbre
