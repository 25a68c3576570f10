#pragma once

#include <string_view>

namespace timbre::cli {

// Files that stand in every page; embed_text.cmake makes the definitions.

[[nodiscard]] std::string_view page_css();
[[nodiscard]] std::string_view viewer_js();
/// three.js of the Debian package, minified.
[[nodiscard]] std::string_view three_js();

}  // namespace timbre::cli
