#include "timbre/analysis/mesh/sampling.h"

#include <limits>
#include <string>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/mesh/triangle.h"

namespace timbre {
namespace {

void require_range(const Points& points, std::int32_t count, std::int32_t start) {
  if (count < 1 || count > points.rows()) {
    throw Error(
        ErrorKind::bad_request, "", "samples",
        "asks for " + std::to_string(count) + " of " + std::to_string(points.rows()) + " points");
  }
  if (start < 0 || start >= points.rows()) {
    throw Error(ErrorKind::bad_request, "", "start",
                "is point " + std::to_string(start) + " of " + std::to_string(points.rows()));
  }
}

}  // namespace

std::vector<std::int32_t> farthest_points(const Points& points, std::int32_t count,
                                          std::int32_t start) {
  require_range(points, count, start);
  const double unit = unit_of({points.data(), static_cast<std::size_t>(points.size())});
  const Points scaled = points / unit;  // so that no square overflows
  constexpr double kChosen = -1.0;
  Eigen::VectorXd distance =
      Eigen::VectorXd::Constant(points.rows(), std::numeric_limits<double>::infinity());
  std::vector<std::int32_t> chosen;
  for (Eigen::Index next = start;;) {
    chosen.push_back(static_cast<std::int32_t>(next));
    if (std::ssize(chosen) == count) return chosen;
    distance[next] = kChosen;
    const Eigen::RowVector3d from = scaled.row(next);
    for (Eigen::Index i = 0; i < scaled.rows(); ++i) {
      distance[i] = std::min(distance[i], (scaled.row(i) - from).squaredNorm());
    }
    next = 0;
    for (Eigen::Index i = 1; i < scaled.rows(); ++i) {
      if (distance[i] > distance[next]) next = i;
    }
  }
}

}  // namespace timbre
