#pragma once

#include <string>

namespace timbre::cli {

/// Version, commit, licence and backends of this build, one a line.
[[nodiscard]] std::string version_text();
/// The version alone: "0.1.0".
[[nodiscard]] std::string version_number();

}  // namespace timbre::cli
