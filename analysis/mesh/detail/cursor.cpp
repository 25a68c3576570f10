#include "timbre/analysis/mesh/detail/cursor.h"

#include <limits>
#include <utility>

#include "timbre/analysis/core/number_text.h"

namespace timbre::detail {
namespace {

constexpr bool is_line_end(char c) { return c == '\n' || c == '\r'; }

std::size_t line_of(std::string_view bytes, std::size_t offset) {
  std::size_t line = 1;
  for (std::size_t i = 0; i < offset; ++i) {
    const bool crlf = bytes[i] == '\r' && i + 1 < bytes.size() && bytes[i + 1] == '\n';
    if (is_line_end(bytes[i]) && !crlf) ++line;
  }
  return line;
}

}  // namespace

void Cursor::expect_text(const TextRules& rules) {
  text_ = true;
  rules_ = rules;
  ends_word_.fill(false);
  for (const char c : std::string_view(" \t\v\f\n\r"))
    ends_word_[static_cast<unsigned char>(c)] = true;
  ends_word_['#'] = rules.hash_comments;
  ends_word_['\\'] = rules.continuation;
}

void Cursor::refuse_nul() const {
  const std::size_t nul = bytes_.find('\0', at_);
  if (nul == std::string_view::npos) return;
  throw Error(ErrorKind::bad_input, "", "byte " + std::to_string(nul), "NUL byte in text");
}

bool Cursor::at_continuation(std::size_t& next_line) const {
  if (!rules_.continuation || now() != '\\') return false;
  next_line = at_ + 1;
  while (next_line < bytes_.size() && is_blank(bytes_[next_line])) ++next_line;
  if (next_line == bytes_.size()) return true;
  if (!is_line_end(bytes_[next_line])) return false;
  next_line += bytes_.substr(next_line).starts_with("\r\n") ? 2 : 1;
  return true;
}

void Cursor::skip_continuations() {
  for (std::size_t next_line = 0; left() > 0 && at_continuation(next_line);) {
    at_ = next_line;
    while (left() > 0 && is_blank(now())) ++at_;
  }
}

void Cursor::skip_line_end() {
  if (left() > 0) at_ += rest().starts_with("\r\n") ? 2 : 1;
}

std::string_view Cursor::word() {
  skip_blanks();
  last_ = at_;
  for (std::size_t next_line = 0;; ++at_) {
    std::size_t at = at_;
    while (at < bytes_.size() && !ends_word_[static_cast<unsigned char>(bytes_[at])]) ++at;
    at_ = at;
    if (left() == 0 || now() != '\\' || at_continuation(next_line)) break;
  }
  return bytes_.substr(last_, at_ - last_);
}

bool Cursor::seek_word() {
  for (;;) {
    skip_blanks();
    if (left() == 0) return false;
    if (!is_line_end(now()) && !(rules_.hash_comments && now() == '#')) return true;
    skip_line();
  }
}

void Cursor::skip_line() {
  std::size_t next_line = 0;
  while (left() > 0 && !is_line_end(now())) {
    if (rules_.hash_comments && now() == '#') {
      at_ = std::min(bytes_.find_first_of("\r\n", at_), bytes_.size());
    } else {
      at_ = at_continuation(next_line) ? next_line : at_ + 1;
    }
  }
  skip_line_end();
}

std::size_t Cursor::count_words() {
  std::size_t count = 0;
  while (!word().empty()) ++count;
  return count;
}

double Cursor::number() {
  skip_blanks();
  const LeadingNumber lead = leading_number(rest());
  if (lead.length > 0 && is_word_end(at_ + lead.length)) {
    last_ = std::exchange(at_, at_ + lead.length);
    return lead.value;
  }
  const std::string_view text = word();
  if (const auto value = parse_double(text)) return *value;
  if (text.empty()) throw error("too few numbers");
  throw error(in_quotes(text) + " is not a decimal number in the range of a double");
}

std::int64_t Cursor::integer() {
  if (const auto value = plain_integer()) return *value;
  const std::string_view text = word();
  if (const auto value = parse_integer(text)) return *value;
  if (text.empty()) throw error("an integer is missing");
  throw error(in_quotes(text) + " is not an integer of 64 bits");
}

std::int32_t Cursor::vertex_index(std::int64_t count) { return checked_index(integer(), count); }

std::int64_t Cursor::checked_count(std::int64_t count, std::uint64_t least_bytes,
                                   const char* elements) const {
  const std::string what = std::to_string(count) + " " + elements;
  if (count < 0) throw error(what + " are declared; at least 0 is needed");
  // The last line may lack its end.
  if (static_cast<std::uint64_t>(count) > (left() + 1) / least_bytes) {
    throw error(what + " are declared, more than the file can hold");
  }
  if (count > std::numeric_limits<std::int32_t>::max()) {
    throw error(what + " are declared; at most 2147483647 can be read");
  }
  return count;
}

Error Cursor::too_short(std::uint64_t count) const {
  return error("truncated: " + std::to_string(count) + " bytes are needed, " +
               std::to_string(left()) + " are left");
}

Error Cursor::out_of_range(std::int64_t index, std::int64_t count) const {
  return error("index " + std::to_string(index) + " is out of range; the file has " +
               std::to_string(count) + " vertices");
}

Error Cursor::error(const std::string& cause) const { return error_at(last_, cause); }

Error Cursor::error_at(std::size_t offset, const std::string& cause) const {
  std::string place =
      text_ ? "line " + std::to_string(line_of(bytes_, offset)) : "byte " + std::to_string(offset);
  if (element_ != nullptr) place += std::string(", ") + element_ + " " + std::to_string(index_);
  return {ErrorKind::bad_input, "", place, cause};
}

Error Cursor::truncated() const {
  std::string cause = "truncated";
  if (element_ != nullptr) {
    cause += std::string(": ") + element_ + " " + std::to_string(index_) + " is missing";
  }
  return {ErrorKind::bad_input, "", "end of file", cause};
}

std::string in_quotes(std::string_view input) {
  constexpr std::size_t kMost = 40;
  if (input.size() <= kMost) return "'" + std::string(input) + "'";
  std::size_t end = kMost;
  while (end > 0 && (static_cast<unsigned char>(input[end]) & 0xc0U) == 0x80U) --end;
  return "'" + std::string(input.substr(0, end)) + "...'";
}

}  // namespace timbre::detail
