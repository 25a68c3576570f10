#pragma once

#include <string>

#include "timbre/cli/command.h"
#include "timbre/matching/refinement.h"

namespace timbre::cli {

/// A point map as text: one 0-based vertex per line, -1 for none.
[[nodiscard]] std::string to_lines(const PointMap& map);

/// A point map as an int32 array.
[[nodiscard]] std::string to_npy_bytes(const PointMap& map);

}  // namespace timbre::cli
