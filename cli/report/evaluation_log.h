#pragma once

#include <optional>
#include <string>
#include <vector>

namespace timbre::cli {

/// A map as `timbre eval match` judged it.
struct EvaluatedMap {
  std::string source, target;   ///< file names in their set
  std::optional<double> error;  ///< mean, in hundredths of the target's size
  double below5 = 0.0;          ///< share of points with an error of at most 5
  double right = 0.0;           ///< share within the bound that counts for symmetries
  bool found = false;
  std::string verdict;  ///< empty: none was given
  std::optional<bool> flipped;
  std::optional<double> seconds;
  std::vector<double> pck;  ///< share of points within 0, 0.5, 1, ...
};

struct EvaluationLog {
  std::string set, kind, geodesic, version;
  std::string method;       ///< empty for maps that were given
  std::string maps_folder;  ///< of maps that were given; empty: they were computed
  int count = 0;            ///< eigenfunctions
  int samples = 0;          ///< rows judged of each; 0: all
  std::vector<EvaluatedMap> maps;
};

/// Between the thresholds of the curves.
inline constexpr double kPckStep = 0.5;

/// Reads what `timbre eval match SET -o FILE` wrote. A last line that was torn off is left out.
/// @throws Error  io; bad_input, with the line, for anything else
[[nodiscard]] EvaluationLog read_evaluation_log(const std::string& path);

}  // namespace timbre::cli
