#include "timbre/analysis/mesh/sampling.h"

#include <gtest/gtest.h>

#include <set>

#include "timbre/analysis/core/error.h"
#include "timbre/tests/support/mesh_shapes.h"

namespace timbre {
namespace {

using Numbers = std::vector<std::int32_t>;

std::string refusal(std::int32_t count, std::int32_t start) {
  try {
    (void)farthest_points(tetrahedron().vertices, count, start);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_request);
    return error.what();
  }
  return "no error";
}

TEST(FarthestPoints, GoesToTheCornersOfASquareFirst) {
  // 5 x 5 points; ties go to the smaller number.
  EXPECT_EQ(farthest_points(grid(4).vertices, 5), (Numbers{0, 24, 4, 20, 12}));
  EXPECT_EQ(farthest_points(grid(4).vertices, 5, 12), (Numbers{12, 0, 4, 20, 24}));
}

TEST(FarthestPoints, ChoosesEveryPointOnceEvenWhereAllCoincide) {
  const Points same = Points::Constant(6, 3, 2.5);
  EXPECT_EQ(farthest_points(same, 6, 3), (Numbers{3, 0, 1, 2, 4, 5}));
  const Numbers all = farthest_points(torus(6, 5).vertices, 30);
  EXPECT_EQ(std::set<std::int32_t>(all.begin(), all.end()).size(), 30U);
}

TEST(FarthestPoints, DoesNotDependOnScale) {
  const Points points = sphere(2).vertices;
  const Numbers expected = farthest_points(points, 20);
  for (const int power : {-1000, -200, 200, 1000}) {
    EXPECT_EQ(farthest_points(points * std::ldexp(1.0, power), 20), expected);
  }
}

TEST(FarthestPoints, RefusesImpossibleRequests) {
  EXPECT_EQ(refusal(0, 0), "samples: asks for 0 of 4 points");
  EXPECT_EQ(refusal(5, 0), "samples: asks for 5 of 4 points");
  EXPECT_EQ(refusal(1, -1), "start: is point -1 of 4");
  EXPECT_EQ(refusal(1, 4), "start: is point 4 of 4");
}

}  // namespace
}  // namespace timbre
