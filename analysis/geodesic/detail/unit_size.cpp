#include "timbre/analysis/geodesic/detail/unit_size.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace timbre::detail {
namespace {

void divide(Points& points, int exponent) {
  for (double& x : points.reshaped()) x = std::ldexp(x, -exponent);
}

}  // namespace

UnitSizeMesh at_unit_size(const TriangleMesh& mesh) {
  UnitSizeMesh result{mesh};
  Points& points = result.mesh.vertices;
  if (points.size() == 0) return result;
  const double most = points.cwiseAbs().maxCoeff();
  if (most == 0.0) return result;
  // In two steps: the first keeps differences below overflow.
  const int first = std::ilogb(most) + 2;
  divide(points, first);
  const Eigen::RowVector3d corner = points.colwise().minCoeff();
  points.rowwise() -= corner;
  const double extent = points.maxCoeff();
  // The unit must be a number itself.
  const int least = std::numeric_limits<double>::min_exponent - 1;
  const int second = std::max(extent > 0.0 ? std::ilogb(extent) : 0, least - first);
  divide(points, second);
  result.unit = std::ldexp(1.0, first + second);
  return result;
}

}  // namespace timbre::detail
