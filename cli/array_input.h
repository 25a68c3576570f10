#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "timbre/cli/command.h"

namespace timbre::cli {

/// A table of numbers: a `.npy` array, or text with a row in each line, numbers parted by
/// blanks; told apart by content. `-` is standard input.
/// @throws Error  bad_input, with file and line, for rows of unlike length or anything else
[[nodiscard]] Eigen::MatrixXd read_table(const Context& context, const std::string& path);

/// A point map, as `timbre match` writes it to .txt and .npy: a target vertex for each source
/// vertex, -1 for none.
[[nodiscard]] std::vector<std::int32_t> read_point_map(const Context& context,
                                                       const std::string& path);

}  // namespace timbre::cli
