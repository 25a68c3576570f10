#include "timbre/datasets/detail/nearest_points.h"

#include <gtest/gtest.h>

#include "timbre/datasets/random.h"

namespace timbre::detail {
namespace {

Points random_points(const char* topic, Eigen::Index n) {
  Random random(topic, {});
  Points points(n, 3);
  for (double& x : points.reshaped()) x = random.uniform(-1.0, 1.0);
  return points;
}

TEST(NearestPoints, AgreeWithComparingAllWithAll) {
  const Points from = random_points("from", 300);
  const Points to = random_points("to", 200);
  const std::vector<std::int32_t> found = nearest_points(from, to);
  for (Eigen::Index v = 0; v < from.rows(); ++v) {
    Eigen::Index best = 0;
    (to.rowwise() - from.row(v)).rowwise().squaredNorm().minCoeff(&best);
    EXPECT_EQ(found[static_cast<std::size_t>(v)], best);
  }
}

TEST(NearestPoints, TakeTheSmallerOfEquallyNear) {
  Points to(4, 3);
  to << 2.0, 0.0, 0.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0, 1.0, 0.0, 0.0;
  EXPECT_EQ(nearest_points(Points::Zero(1, 3), to), std::vector<std::int32_t>{1});
}

}  // namespace
}  // namespace timbre::detail
