#pragma once

#include <Eigen/Core>
#include <limits>

namespace timbre {

/// (lambda_(i+1) - lambda_i) / lambda_(i+1), in [0, 1]: how well eigenvalue i is told from the
/// next one. Near 0 the eigenfunctions of both are any two of their common eigenspace, and what is
/// made of the lower ones alone hangs on rounding. NaN where the next one is not known.
/// @param values  ascending, 0 or more
[[nodiscard]] inline double relative_gap(const Eigen::VectorXd& values, Eigen::Index i) {
  if (i < 0 || i + 1 >= values.size()) return std::numeric_limits<double>::quiet_NaN();
  return values[i + 1] > 0.0 ? (values[i + 1] - values[i]) / values[i + 1] : 0.0;
}

}  // namespace timbre
