#include "timbre/datasets/detail/nearest_points.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace timbre::detail {
namespace {

using Eigen::Index;

Index longest_axis(const Points& points) {
  Index axis = 0;
  (points.colwise().maxCoeff() - points.colwise().minCoeff()).maxCoeff(&axis);
  return axis;
}

}  // namespace

// Targets in order of one coordinate, looked at outward from the query until that coordinate
// alone is too far.
std::vector<std::int32_t> nearest_points(const Points& from, const Points& to) {
  const Index axis = longest_axis(to);
  std::vector<std::int32_t> order(static_cast<std::size_t>(to.rows()));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](std::int32_t a, std::int32_t b) { return to(a, axis) < to(b, axis); });
  const Points sorted = to(order, Eigen::all);
  const Eigen::VectorXd along = sorted.col(axis);
  std::vector<std::int32_t> result(static_cast<std::size_t>(from.rows()));
  for (Index v = 0; v < from.rows(); ++v) {
    const Eigen::RowVector3d point = from.row(v);
    double least = std::numeric_limits<double>::infinity();
    std::int32_t best = 0;
    // Whether the search may go on beyond row i.
    const auto look = [&](Index i) {
      const double gap = along[i] - point[axis];
      if (gap * gap > least) return false;
      const double squared = (sorted.row(i) - point).squaredNorm();
      const std::int32_t original = order[static_cast<std::size_t>(i)];
      if (squared > least || (squared == least && original > best)) return true;
      least = squared;
      best = original;
      return true;
    };
    const Index start = std::lower_bound(along.begin(), along.end(), point[axis]) - along.begin();
    for (Index i = start; i < along.size() && look(i);) ++i;
    for (Index i = start - 1; i >= 0 && look(i);) --i;
    result[static_cast<std::size_t>(v)] = best;
  }
  return result;
}

}  // namespace timbre::detail
