#pragma once

#include <Eigen/Core>
#include <vector>

namespace timbre {

/// A column for each row, no two the same, with the largest sum of entries. Cost: rows^2 columns.
///
/// @param profit  rows x columns, finite
/// @throws Error  bad_request if there are more rows than columns
/// @see Jonker and Volgenant 1987 (shortest augmenting paths)
[[nodiscard]] std::vector<int> best_assignment(const Eigen::MatrixXd& profit);

}  // namespace timbre
