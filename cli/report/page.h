#pragma once

#include <string>
#include <string_view>

namespace timbre::cli {

/// A whole HTML page around its content: head, style, a policy that forbids every request.
/// @param has_viewer  whether the scripts of the 3D view are needed
[[nodiscard]] std::string page(std::string_view title, std::string_view content, bool has_viewer);

}  // namespace timbre::cli
