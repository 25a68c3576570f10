#pragma once

#include <string>
#include <string_view>

namespace timbre::detail {

/// How names stand in messages.
[[nodiscard]] inline std::string in_quotes(const std::string& name) { return "'" + name + "'"; }

/// True for well-formed UTF-8: shortest forms, no surrogates, at most U+10FFFF.
[[nodiscard]] bool is_utf8(std::string_view text);

/// @throws Error  bad_request for the location of a server, which this build cannot reach
void require_local(const std::string& location);

}  // namespace timbre::detail
