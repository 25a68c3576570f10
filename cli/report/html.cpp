#include "timbre/cli/report/html.h"

#include <algorithm>
#include <cctype>
#include <cstdint>

namespace timbre::cli {
namespace {

constexpr std::string_view kReplacement = "\xef\xbf\xbd";

// Bytes of the well-formed character that begins a text; 0 if none does.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = byte(0);
  if (first < 0x80) return 1;
  if (first < 0xc2 || first > 0xf4) return 0;
  const std::size_t length = first < 0xe0 ? 2 : (first < 0xf0 ? 3 : 4);
  if (text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0U) != 0x80) return 0;
  }
  // Overlong forms, surrogates, and what lies beyond the last code point.
  const std::uint8_t second = byte(1);
  if ((first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f) ||
      (first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f)) {
    return 0;
  }
  return length;
}

std::string_view entity_of(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    default:
      return {};
  }
}

bool is_control(char c) {
  const auto byte = static_cast<std::uint8_t>(c);
  return (byte < 0x20 && c != '\n' && c != '\t') || byte == 0x7f;
}

std::string row(std::string_view tag, const std::vector<TableCell>& cells, bool is_head) {
  std::string content;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    Attributes attributes;
    const bool names = is_head || i == 0;
    if (names) attributes.emplace_back("scope", is_head ? "col" : "row");
    if (cells[i].is_number) attributes.emplace_back("class", "number");
    content += element(names ? "th" : "td", attributes, escape_html(cells[i].text));
  }
  return element(tag, content) + "\n";
}

}  // namespace

std::string escape_html(std::string_view text) {
  std::string html;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    const std::string_view entity = entity_of(text[0]);
    if (length == 0 || is_control(text[0])) {
      html += kReplacement;
    } else {
      html += entity.empty() ? text.substr(0, length) : entity;
    }
    text.remove_prefix(std::max<std::size_t>(1, length));
  }
  return html;
}

std::string element(std::string_view tag, std::string_view content) {
  return element(tag, {}, content);
}

std::string element(std::string_view tag, const Attributes& attributes, std::string_view content) {
  std::string html = "<" + std::string(tag);
  for (const auto& [name, value] : attributes) {
    html += " " + std::string(name) + "=\"" + escape_html(value) + "\"";
  }
  html += ">";
  html += content;
  return html + "</" + std::string(tag) + ">";
}

std::string figure(std::string_view kind, std::string_view content, std::string_view caption) {
  return element("figure", {{"class", std::string(kind)}},
                 std::string(content) + element("figcaption", caption)) +
         "\n";
}

std::string section(const std::string& id, std::string_view heading, std::string_view content) {
  const std::string title = element("h2", {{"id", id + "-title"}}, escape_html(heading));
  return element("section", {{"id", id}, {"aria-labelledby", id + "-title"}},
                 "\n" + title + "\n" + std::string(content)) +
         "\n";
}

std::string command_line(std::string_view command) {
  return element("pre", {{"tabindex", "0"}}, element("code", escape_html(command))) + "\n";
}

std::string table(std::string_view caption, const std::vector<TableCell>& head,
                  const std::vector<std::vector<TableCell>>& rows) {
  std::string body;
  for (const std::vector<TableCell>& cells : rows) body += row("tr", cells, false);
  const std::string content = element("caption", escape_html(caption)) +
                              element("thead", row("tr", head, true)) + element("tbody", body);
  return element("div", {{"class", "table"}, {"tabindex", "0"}}, element("table", content)) + "\n";
}

std::string to_base64(std::string_view bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t bits = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      bits = bits << 8U | (j < count ? static_cast<std::uint8_t>(bytes[i + j]) : 0U);
    }
    for (std::size_t j = 0; j < 4; ++j) {
      text += j <= count ? kDigits[bits >> (18 - 6 * j) & 0x3fU] : '=';
    }
  }
  return text;
}

std::string shell_word(std::string_view text) {
  const auto is_plain = [](unsigned char c) {
    return c >= 0x80 || std::isalnum(c) != 0 ||
           std::string_view("_-./=+,:@%").find(static_cast<char>(c)) != std::string_view::npos;
  };
  if (!text.empty() && std::all_of(text.begin(), text.end(), is_plain)) return std::string(text);
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

}  // namespace timbre::cli
