#include "timbre/matching/selection.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "timbre/matching/candidates.h"
#include "timbre/matching/deformation.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Distances among the geodesic samples; what cannot be reached is as far as a shape is wide.
MatrixXd sample_distances(const MatchSurface& s) {
  const std::vector<std::int32_t> columns(s.samples.begin(),
                                          s.samples.begin() + s.distances.rows());
  constexpr float kUnreachable = 2.0F;
  return s.distances(Eigen::all, columns).cwiseMin(kUnreachable).cast<double>();
}

double cosine(const Eigen::Ref<const VectorXd>& x, const Eigen::Ref<const VectorXd>& y) {
  return x.dot(y) / (x.norm() * y.norm() + 1e-15);
}

double distinct(const PointMap& map) {
  PointMap sorted = map;
  std::sort(sorted.begin(), sorted.end());
  return static_cast<double>(std::unique(sorted.begin(), sorted.end()) - sorted.begin());
}

double geodesic_change(const MatrixXd& DA, const MatrixXd& DB, const VectorXd& wa,
                       const PointMap& ab) {
  return wa.dot((DA - DB(ab, ab)).cwiseAbs() * wa);
}

double round_trip(const MatrixXd& DA, const VectorXd& wa, const PointMaps& maps) {
  double sum = 0.0;
  for (Index i = 0; i < wa.size(); ++i) {
    const std::int32_t there = maps.ab[static_cast<std::size_t>(i)];
    sum += wa[i] * DA(i, maps.ba[static_cast<std::size_t>(there)]);
  }
  return sum;
}

// Mean change of Euclidean distances between samples that are near on A.
double local_stretch(const MatchSurface& A, const MatchSurface& B, const MatrixXd& DA,
                     const PointMap& ab) {
  constexpr double kNear = 0.05;
  constexpr double kFar = 0.25;
  const auto at = [](const MatchSurface& s, std::int32_t sample) {
    return s.points.row(s.samples[static_cast<std::size_t>(sample)]);
  };
  double sum = 0.0;
  double count = 0.0;
  for (Index i = 0; i < DA.rows(); ++i) {
    for (Index j = 0; j < DA.cols(); ++j) {
      if (DA(i, j) <= kNear || DA(i, j) >= kFar) continue;
      const double before =
          (at(A, static_cast<std::int32_t>(i)) - at(A, static_cast<std::int32_t>(j))).norm();
      const double after =
          (at(B, ab[static_cast<std::size_t>(i)]) - at(B, ab[static_cast<std::size_t>(j)])).norm();
      sum += std::abs(before - after);
      count += 1.0;
    }
  }
  return count > 0.0 ? sum / count / kFar : 0.0;
}

double carried_curvature(const MatchSurface& A, const MatchSurface& B, const MatrixXd& C) {
  const Index k = C.rows();
  return cosine(A.curvature.head(k), C * B.curvature.head(k));
}

double round_trip_in_space(const MatchSurface& A, const PointMaps& maps) {
  double sum = 0.0;
  for (Index i = 0; i < A.points.rows(); ++i) {
    const std::int32_t back =
        maps.ba[static_cast<std::size_t>(maps.ab[static_cast<std::size_t>(i)])];
    sum += A.mass[i] * (A.points.row(back) - A.points.row(i)).norm();
  }
  return sum;
}

}  // namespace

MapEnergies measure_energies(const MatchSurface& A, const MatchSurface& B,
                             const SampledMaps& maps) {
  const MatrixXd DA = sample_distances(A);
  const MatrixXd DB = sample_distances(B);
  const VectorXd wa = A.sample_mass / A.sample_mass.sum();
  const VectorXd wb = B.sample_mass / B.sample_mass.sum();
  const PointMaps& points = maps.points;
  const auto& [ab, ba] = maps.functional;

  MapEnergies e;
  e.geodesic =
      0.5 * (geodesic_change(DA, DB, wa, points.ab) + geodesic_change(DB, DA, wb, points.ba));
  e.bijectivity = 0.5 * (round_trip(DA, wa, points) + round_trip(DB, wb, {points.ba, points.ab}));
  e.coverage = 0.5 * (distinct(points.ab) / static_cast<double>(wb.size()) +
                      distinct(points.ba) / static_cast<double>(wa.size()));
  e.commutation = commutation_error(A, B, ab, 30);
  e.stretch = 0.5 * (local_stretch(A, B, DA, points.ab) + local_stretch(B, A, DB, points.ba));
  e.curvature = 0.5 * (carried_curvature(A, B, ab) + carried_curvature(B, A, ba));
  const Index k = std::min<Index>(
      {15, ab.rows() - 1, static_cast<Index>(A.areas.size()), static_cast<Index>(B.areas.size())});
  const MatrixXd low_ab = ab.block(1, 1, k, k);
  const MatrixXd low_ba = ba.block(1, 1, k, k);
  e.products = 0.5 * (tensor_correlation(A.products, B.products, low_ab) +
                      tensor_correlation(B.products, A.products, low_ba));
  e.areas = 0.5 * (tensor_correlation(A.areas, B.areas, low_ab) +
                   tensor_correlation(B.areas, A.areas, low_ba));
  return e;
}

double sample_score(const MapEnergies& e, int orientation) {
  return 10.0 * e.geodesic + 10.0 * e.bijectivity + e.commutation + 10.0 * e.stretch -
         2.0 * e.curvature - 0.5 * orientation * e.areas;
}

double curvature_bands(const MatchSurface& A, const MatchSurface& B, const FunctionalMaps& maps) {
  const Index k = maps.ab.rows();
  const VectorXd to_a = maps.ab * B.curvature.head(k);
  const VectorXd to_b = maps.ba * A.curvature.head(k);
  double sum = 0.0;
  for (const auto& [low, high] : {std::pair<Index, Index>(20, 60), {40, k}, {60, k}}) {
    const Index end = std::min(high, k);
    const Index begin = std::min(low, end / 2);
    const auto band = Eigen::seqN(begin, end - begin);
    sum += 0.5 * (cosine(A.curvature(band), to_a(band)) + cosine(B.curvature(band), to_b(band)));
  }
  return sum / 3.0;
}

double commutation_error(const MatchSurface& A, const MatchSurface& B, const MatrixXd& C,
                         Index size) {
  const Index k = std::min(size, C.rows());
  double sum = 0.0;
  for (Index i = 0; i < k; ++i) {
    for (Index j = 0; j < k; ++j) {
      sum += std::pow(C(i, j) * (A.values[i] - B.values[j]), 2);
    }
  }
  return std::sqrt(sum) / A.values.head(k).norm();
}

double dense_score(const MatchSurface& A, const MatchSurface& B, const DenseMaps& maps,
                   int orientation) {
  constexpr Index kPoseSize = 150;
  const Index k = maps.functional.ab.rows();
  return commutation_error(A, B, maps.functional.ab, k) +
         10.0 * round_trip_in_space(A, maps.points) -
         0.5 * (covered_area(A, maps.points.ba) + covered_area(B, maps.points.ab)) +
         10.0 * pose_residual(A, B, maps.points.ab, kPoseSize, orientation);
}

double covered_area(const MatchSurface& B, const PointMap& ab) {
  std::vector<bool> hit(static_cast<std::size_t>(B.mass.size()), false);
  double area = 0.0;
  for (const std::int32_t image : ab) {
    const auto at = static_cast<std::size_t>(image);
    if (!hit[at]) area += B.mass[image];
    hit[at] = true;
  }
  return area;
}

double map_distance(const MatchSurface& A, const MatchSurface& B, const PointMap& S,
                    const PointMap& T) {
  double sum = 0.0;
  for (Index i = 0; i < A.sample_mass.size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const auto target = static_cast<std::size_t>(T[at]);
    sum += A.sample_mass[i] * std::min(2.0F, B.distances(S[at], B.samples[target]));
  }
  return sum / A.sample_mass.sum();
}

}  // namespace timbre
