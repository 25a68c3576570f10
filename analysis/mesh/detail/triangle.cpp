#include "timbre/analysis/mesh/detail/triangle.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace timbre::detail {
namespace {

Eigen::Vector3d edge(const double* from, const double* to, double unit) {
  return {to[0] / unit - from[0] / unit, to[1] / unit - from[1] / unit,
          to[2] / unit - from[2] / unit};
}

}  // namespace

double unit_of(std::span<const double> coordinates) {
  double largest = 0.0;
  for (const double c : coordinates) largest = std::max(largest, std::abs(c));
  return largest > 0.0 ? std::ldexp(1.0, std::ilogb(largest)) : 1.0;
}

double triangle_area(const double* a, const double* b, const double* c, double unit) {
  return 0.5 * edge(a, b, unit).cross(edge(a, c, unit)).stableNorm();
}

bool has_no_area(const double* a, const double* b, const double* c, double unit) {
  Eigen::Vector3d u = edge(a, b, unit);
  Eigen::Vector3d v = edge(a, c, unit);
  const double size = std::max(u.cwiseAbs().maxCoeff(), v.cwiseAbs().maxCoeff());
  if (size == 0.0) return true;
  u /= size;
  v /= size;
  const double longest = std::max({u.squaredNorm(), v.squaredNorm(), (u - v).squaredNorm()});
  return u.cross(v).norm() <= 1e-15 * longest;
}

}  // namespace timbre::detail
