#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace timbre::cli {

// Pieces of an HTML page. Arguments called `content` are HTML already, all others are text.

/// Text as HTML: `&`, `<`, `>` and both quotes are escaped; bytes that are no UTF-8 and control
/// characters become the replacement character.
[[nodiscard]] std::string escape_html(std::string_view text);

using Attributes = std::vector<std::pair<std::string_view, std::string>>;

[[nodiscard]] std::string element(std::string_view tag, std::string_view content);
[[nodiscard]] std::string element(std::string_view tag, const Attributes& attributes,
                                  std::string_view content);

/// A figure with its caption.
[[nodiscard]] std::string figure(std::string_view kind, std::string_view content,
                                 std::string_view caption);

/// A part of the page, with an anchor.
[[nodiscard]] std::string section(const std::string& id, std::string_view heading,
                                  std::string_view content);

/// A command as one would type it.
[[nodiscard]] std::string command_line(std::string_view command);

struct TableCell {
  std::string text;
  bool is_number = false;  ///< set to the right
};

/// A table that scrolls in a box of its own where it is too wide; the first column names the
/// rows.
[[nodiscard]] std::string table(std::string_view caption, const std::vector<TableCell>& head,
                                const std::vector<std::vector<TableCell>>& rows);

[[nodiscard]] std::string to_base64(std::string_view bytes);

/// A word of a shell's command line: quoted where it must be.
[[nodiscard]] std::string shell_word(std::string_view text);

}  // namespace timbre::cli
