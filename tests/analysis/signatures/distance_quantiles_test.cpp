#include "timbre/analysis/signatures/distance_quantiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "timbre/analysis/core/error.h"

namespace timbre {
namespace {

Eigen::MatrixXd cloud(Eigen::Index n, unsigned seed) {
  std::mt19937 draw(seed);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd points(n, 3);
  for (double& entry : points.reshaped()) entry = normal(draw);
  return points;
}

TEST(ComputeDistanceQuantiles, GivesTheDistanceOfTwoPoints) {
  Eigen::MatrixXd points(2, 1);
  points << 0.0, 3.0;
  const Eigen::VectorXd found =
      compute_distance_quantiles(points, Eigen::Vector2d(1.0, 1.0), {.samples = 2, .quantiles = 4});
  EXPECT_EQ(found, Eigen::VectorXd::Constant(4, 3.0));
}

// Points at 0, 1, 3: distances 1, 2, 3, whose shares have midpoints 1/6, 1/2, 5/6.
TEST(ComputeDistanceQuantiles, InterpolatesBetweenMidpoints) {
  const Eigen::MatrixXd points = Eigen::Vector3d(0.0, 1.0, 3.0);
  const Eigen::VectorXd found =
      compute_distance_quantiles(points, Eigen::Vector3d::Ones(), {.samples = 3, .quantiles = 4});
  EXPECT_TRUE(found.isApprox(Eigen::Vector4d(1.0, 1.625, 2.375, 3.0), 1e-14)) << found;
}

TEST(ComputeDistanceQuantiles, DrawsByAreaAndNeverAVertexWithout) {
  Eigen::MatrixXd points(3, 1);
  points << 0.0, 1.0, 1000.0;
  const Eigen::VectorXd found = compute_distance_quantiles(points, Eigen::Vector3d(1.0, 3.0, 0.0),
                                                           {.samples = 8, .quantiles = 16});
  EXPECT_EQ(found.maxCoeff(), 1.0);
  // 2 of 8 at the origin: 12 of 28 pairs are apart.
  EXPECT_NEAR(found.mean(), 12.0 / 28.0, 0.02);
}

TEST(ComputeDistanceQuantiles, DependsNeitherOnOrderNorSignsNorRotation) {
  const Eigen::MatrixXd points = cloud(300, 3);
  const Eigen::VectorXd masses = cloud(300, 4).col(0).cwiseAbs();
  const Eigen::VectorXd before = compute_distance_quantiles(points, masses);
  Eigen::PermutationMatrix<Eigen::Dynamic> order(300);
  order.setIdentity();
  std::mt19937 draw(5);
  std::shuffle(order.indices().begin(), order.indices().end(), draw);
  EXPECT_LT((compute_distance_quantiles(order * points, order * masses) - before).norm(), 1e-12);
  Eigen::Matrix3d turn;
  turn << 0.6, -0.8, 0.0, 0.8, 0.6, 0.0, 0.0, 0.0, -1.0;
  EXPECT_LT((compute_distance_quantiles(points * turn, masses) - before).norm(), 1e-12);
}

TEST(ComputeDistanceQuantiles, RefusesWhatItCannotMeasure) {
  const Eigen::MatrixXd points = cloud(4, 1);
  EXPECT_THROW((void)compute_distance_quantiles(points, Eigen::VectorXd::Zero(4)), Error);
  EXPECT_THROW((void)compute_distance_quantiles(points, Eigen::VectorXd::Ones(3)), Error);
  EXPECT_THROW((void)compute_distance_quantiles(points, Eigen::VectorXd::Ones(4), {.samples = 1}),
               Error);
}

}  // namespace
}  // namespace timbre
