#include "timbre/datasets/detail/nearest_points.h"

namespace timbre::detail {

std::vector<std::int32_t> nearest_points(const Points& from, const Points& to) {
  // A column for each coordinate: the loop over `to` then runs through memory in order.
  const Eigen::ArrayX3d target = to;
  Eigen::ArrayXd squared(to.rows());
  std::vector<std::int32_t> result(static_cast<std::size_t>(from.rows()));
  for (Eigen::Index v = 0; v < from.rows(); ++v) {
    squared = (target.col(0) - from(v, 0)).square() + (target.col(1) - from(v, 1)).square() +
              (target.col(2) - from(v, 2)).square();
    Eigen::Index best = 0;
    squared.minCoeff(&best);
    result[static_cast<std::size_t>(v)] = static_cast<std::int32_t>(best);
  }
  return result;
}

}  // namespace timbre::detail
