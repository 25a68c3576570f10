#include "timbre/cli/commands/map_output.h"

#include "timbre/analysis/core/array_file.h"

namespace timbre::cli {

std::string to_lines(const PointMap& map) {
  std::string text;
  for (const std::int32_t image : map) text += std::to_string(image) + "\n";
  return text;
}

std::string to_npy_bytes(const PointMap& map) {
  return to_npy(Eigen::VectorXi(
      Eigen::Map<const Eigen::VectorXi>(map.data(), static_cast<Eigen::Index>(map.size()))));
}

}  // namespace timbre::cli
