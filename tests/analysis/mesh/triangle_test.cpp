#include "timbre/analysis/mesh/triangle.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace timbre {
namespace {

bool is_flat(std::array<double, 9> corners, double scale) {
  for (double& c : corners) c *= scale;
  return has_no_area(corners.data(), corners.data() + 3, corners.data() + 6,
                     1.0 / unit_of(corners));
}

TEST(HasNoArea, DoesNotDependOnScale) {
  for (const double scale : {1.0, 1e300, 1e-200, 1e-310, 3e-324 / 1e-16}) {
    EXPECT_FALSE(is_flat({0, 0, 0, 1, 0, 0, 0, 1, 0}, scale)) << scale;
    EXPECT_TRUE(is_flat({0, 0, 0, 1, 1, 0, 2, 2, 0}, scale)) << scale;
  }
  EXPECT_TRUE(is_flat({1, 2, 3, 1, 2, 3, 1, 2, 3}, 1.0));
  EXPECT_FALSE(is_flat({0, 0, 0, 1, 0, 0, 0.5, 1e-14, 0}, 1.0));
  EXPECT_TRUE(is_flat({0, 0, 0, 1, 0, 0, 0.5, 5e-16, 0}, 1.0));
}

TEST(HasNoArea, SeesATinyTriangleBesideALargeCoordinate) {
  const std::array<double, 9> tiny = {0, 0, 0, 1e-170, 0, 0, 0, 1e-170, 0};
  EXPECT_FALSE(has_no_area(tiny.data(), tiny.data() + 3, tiny.data() + 6, 1.0));
}

TEST(UnitOf, IsAPowerOfTwoNearTheLargest) {
  EXPECT_EQ(unit_of(std::vector{0.3, -5.0}), 4.0);
  EXPECT_EQ(unit_of(std::vector{0.0}), 1.0);
  EXPECT_EQ(unit_of({}), 1.0);
}

TEST(TriangleArea, IsInSquaresOfTheUnit) {
  const std::array<double, 9> corners = {0, 0, 0, 6, 0, 0, 0, 4, 0};
  EXPECT_DOUBLE_EQ(triangle_area(corners.data(), corners.data() + 3, corners.data() + 6, 0.25),
                   12.0 / 16.0);
}

}  // namespace
}  // namespace timbre
