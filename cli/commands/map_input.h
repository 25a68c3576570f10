#pragma once

#include <string>

#include "timbre/cli/command.h"
#include "timbre/matching/surface.h"

namespace timbre::cli {

/// A mesh prepared for matching with so many eigenfunctions; notes where a part of it is left out.
/// @param path  for messages
[[nodiscard]] MatchSurface prepare_for_matching(const Context& context, const std::string& path,
                                                const TriangleMesh& mesh, int count);

/// The same of a file.
[[nodiscard]] MatchSurface load_surface(const Context& context, const std::string& path, int count);

}  // namespace timbre::cli
