#include "timbre/analysis/mesh/triangle.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace timbre {
namespace {

using Eigen::Vector3d;

Vector3d edge(const double* from, const double* to, double per_unit) {
  return {to[0] * per_unit - from[0] * per_unit, to[1] * per_unit - from[1] * per_unit,
          to[2] * per_unit - from[2] * per_unit};
}

bool is_flat(const Vector3d& u, const Vector3d& v) {
  const double longest = std::max({u.squaredNorm(), v.squaredNorm(), (u - v).squaredNorm()});
  return u.cross(v).squaredNorm() <= 1e-30 * longest * longest;
}

}  // namespace

double unit_of(std::span<const double> coordinates) {
  double largest = 0.0;
  for (const double c : coordinates) largest = std::max(largest, std::abs(c));
  constexpr int kLeast = -1000;  // smaller ones have no inverse, and are far from overflow
  return largest > 0.0 ? std::ldexp(1.0, std::max(std::ilogb(largest), kLeast)) : 1.0;
}

double triangle_area(const double* a, const double* b, const double* c, double per_unit) {
  return 0.5 * edge(a, b, per_unit).cross(edge(a, c, per_unit)).norm();
}

bool detail::has_no_area_at_any_scale(const double* a, const double* b, const double* c,
                                      double per_unit) {
  Vector3d u = edge(a, b, per_unit);
  Vector3d v = edge(a, c, per_unit);
  if (!is_flat(u, v)) return false;
  // Perhaps it is only so small that the products vanish.
  const double size = std::max(u.cwiseAbs().maxCoeff(), v.cwiseAbs().maxCoeff());
  return size == 0.0 || is_flat(u / size, v / size);
}

}  // namespace timbre
