#include "timbre/analysis/signatures/distance_quantiles.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "timbre/analysis/core/error.h"

namespace timbre {
namespace {

using Eigen::Index;

// Columns are the sampled points: pairs then read memory in order.
Eigen::MatrixXd draw_by_area(const Eigen::MatrixXd& coordinates, const Eigen::VectorXd& masses,
                             int samples) {
  const Eigen::VectorXd radius = coordinates.rowwise().squaredNorm();
  std::vector<Index> order(static_cast<std::size_t>(masses.size()));
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return radius(a) < radius(b); });
  const double step = masses.sum() / samples;
  Eigen::MatrixXd drawn(coordinates.cols(), samples);
  double passed = 0.0;
  int next = 0;
  Index last = -1;
  for (const Index vertex : order) {
    if (!(masses(vertex) > 0.0)) continue;
    last = vertex;
    passed += masses(vertex);
    for (; next < samples && (next + 0.5) * step <= passed; ++next) {
      drawn.col(next) = coordinates.row(vertex).transpose();
    }
  }
  // Rounding may leave the last step just beyond the sum.
  for (; next < samples; ++next) drawn.col(next) = coordinates.row(last).transpose();
  return drawn;
}

// Between the midpoints of the sorted values' shares, linearly.
double quantile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size()) - 0.5;
  if (place <= 0.0) return sorted.front();
  const auto below = static_cast<std::size_t>(place);
  if (below + 1 >= sorted.size()) return sorted.back();
  return std::lerp(sorted[below], sorted[below + 1], place - static_cast<double>(below));
}

}  // namespace

Eigen::VectorXd compute_distance_quantiles(const Eigen::MatrixXd& coordinates,
                                           const Eigen::VectorXd& masses,
                                           const DistanceQuantilesOptions& options) {
  if (options.samples < 2 || options.quantiles < 1 || masses.size() != coordinates.rows() ||
      !(masses.sum() > 0.0)) {
    throw Error(ErrorKind::bad_request, "", "distance quantiles",
                "need at least 2 samples, 1 quantile and one mass per vertex, not all zero");
  }
  const Eigen::MatrixXd points = draw_by_area(coordinates, masses, options.samples);
  std::vector<double> distances;
  distances.reserve(static_cast<std::size_t>(points.cols() * (points.cols() - 1) / 2));
  for (Index i = 0; i < points.cols(); ++i) {
    for (Index j = i + 1; j < points.cols(); ++j) {
      distances.push_back((points.col(i) - points.col(j)).norm());
    }
  }
  std::sort(distances.begin(), distances.end());
  Eigen::VectorXd out(options.quantiles);
  for (Index q = 0; q < out.size(); ++q) {
    out(q) = quantile(distances, (static_cast<double>(q) + 0.5) / options.quantiles);
  }
  return out;
}

}  // namespace timbre
