#include "timbre/analysis/operators/detail/surface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "timbre/tests/support/mesh_shapes.h"

namespace timbre::detail {
namespace {

TEST(TriangleArea, KeepsItsDigitsOnNeedles) {
  EXPECT_DOUBLE_EQ(triangle_area({3, 4, 5}), 6.0);
  // Sides 1, 1 and 2 - e: half of (2 - e) sqrt(e - e^2 / 4).
  const double e = 0x1p-40;
  EXPECT_DOUBLE_EQ(triangle_area({1, 2 - e, 1}), 0.25 * (2 - e) * 2.0 * std::sqrt(e - e * e / 4));
  EXPECT_EQ(triangle_area({1, 2, 1}), 0.0);
  EXPECT_EQ(triangle_area({1, 3, 1}), 0.0);
}

TEST(Cotangents, AreThoseOfTheAnglesAtTheCorners) {
  const auto cotangent = cotangents({1, std::sqrt(3.0), 2}, std::sqrt(3.0) / 2);  // 30, 60, 90
  EXPECT_NEAR(cotangent[0], std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(cotangent[1], 1 / std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(cotangent[2], 0.0, 1e-15);
}

TEST(MakeSurface, RaisesLengthsOfTheComponentThatNeedsItOnly) {
  // A sound triangle, and two of which one lies on a line.
  const TriangleMesh mesh =
      make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {8, 0, 0}, {9, 0, 0}, {10, 0, 0}, {8, 1, 0}},
                {{0, 1, 2}, {3, 4, 5}, {3, 4, 6}});
  const Surface surface = make_surface(mesh, 1e-5);
  ASSERT_EQ(surface.scales.size(), 2U);
  EXPECT_EQ(surface.scales[0].raise, 0.0);
  EXPECT_NEAR(surface.scales[1].raise, 1e-5 * surface.scales[1].mean_length, 1e-15);
  EXPECT_EQ(surface.faces[0].length[1], 1.0);
  for (const MetricFace& face : surface.faces) {
    const double sum = face.length[0] + face.length[1] + face.length[2];
    for (const double length : face.length) EXPECT_GT(sum - 2 * length, 0.0);
  }
}

// Two equal triangles, each a component, whose sizes are powers of two.
Surface surface_of_two(int first_exponent, int second_exponent) {
  TriangleMesh mesh = make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}},
                                {{0, 1, 2}, {3, 4, 5}});
  mesh.vertices.topRows(3) *= std::ldexp(1.0, first_exponent);
  mesh.vertices.bottomRows(3) *= std::ldexp(1.0, second_exponent);
  return make_surface(mesh, 1e-5);
}

TEST(MakeSurface, GivesEachComponentItsOwnUnit) {
  for (const auto& [first, second] : {std::pair{300, -60}, std::pair{500, -500}}) {
    const Surface surface = surface_of_two(first, second);
    EXPECT_EQ(surface.scales[0].exponent - surface.scales[1].exponent, first - second);
    EXPECT_EQ(surface.faces[0].length, surface.faces[1].length);
  }
}

TEST(MakeSurface, LeavesOutAComponentThatVanishesBesideTheOthers) {
  const Surface surface = surface_of_two(990, -100);
  EXPECT_EQ(surface.left_out, 1);
  EXPECT_EQ(surface.scales.size(), 1U);
}

}  // namespace
}  // namespace timbre::detail
