#include "timbre/analysis/operators/detail/linear_elements.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace timbre::detail {
namespace {

using Eigen::VectorXd;

// Shares of one triangle's area that belong to its corners.
std::array<double, 3> circumcentric_shares(const MetricFace& face) {
  const double area = triangle_area(face.length);
  const std::array<double, 3> cotangent = cotangents(face.length, area);
  std::array<double, 3> share{};
  for (std::size_t c = 0; c < 3; ++c) {
    if (cotangent[c] >= 0.0) continue;
    share.fill(0.25);
    share[c] = 0.5;
    return share;
  }
  for (std::size_t c = 0; c < 3; ++c) {
    for (const std::size_t other : {(c + 1) % 3, (c + 2) % 3}) {
      share[c] += face.length[other] * face.length[other] * cotangent[other] / (8.0 * area);
    }
  }
  return share;
}

}  // namespace

double true_area(const Surface& surface, const MetricFace& face) {
  return std::ldexp(triangle_area(face.length), 2 * surface.scale_at(face.corner[0]).exponent);
}

std::vector<MatrixPair> cotangent_weights(const std::vector<MetricFace>& faces) {
  std::vector<MatrixPair> weights;
  weights.reserve(3 * faces.size());
  for (const MetricFace& face : faces) {
    const std::array<double, 3> cotangent = cotangents(face.length, triangle_area(face.length));
    for (std::size_t c = 0; c < 3; ++c) {
      weights.push_back({face.corner[(c + 1) % 3], face.corner[(c + 2) % 3], 0.5 * cotangent[c]});
    }
  }
  return weights;
}

VectorXd barycentric_areas(const Surface& surface, const std::vector<MetricFace>& faces) {
  VectorXd areas = VectorXd::Zero(surface.vertices());
  for (const MetricFace& face : faces) {
    const double third = true_area(surface, face) / 3.0;
    for (const std::int32_t corner : face.corner) areas[corner] += third;
  }
  return areas;
}

VectorXd circumcentric_areas(const Surface& surface, const std::vector<MetricFace>& faces) {
  VectorXd areas = VectorXd::Zero(surface.vertices());
  for (const MetricFace& face : faces) {
    const double area = true_area(surface, face);
    const std::array<double, 3> share = circumcentric_shares(face);
    for (std::size_t c = 0; c < 3; ++c) areas[face.corner[c]] += area * share[c];
  }
  return areas;
}

std::vector<MatrixPair> galerkin_pairs(const Surface& surface,
                                       const std::vector<MetricFace>& faces) {
  std::vector<MatrixPair> pairs;
  pairs.reserve(3 * faces.size());
  for (const MetricFace& face : faces) {
    const double part = true_area(surface, face) / 12.0;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::int32_t a = face.corner[c];
      const std::int32_t b = face.corner[(c + 1) % 3];
      // An intrinsic edge may be a loop; both its entries are then one of the diagonal.
      pairs.push_back({a, b, a == b ? 2.0 * part : part});
    }
  }
  return pairs;
}

}  // namespace timbre::detail
