#include "timbre/analysis/mesh/detail/triangulate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

namespace timbre::detail {
namespace {

using Plane = std::vector<std::array<double, 2>>;

double twice_area(const std::array<double, 2>& a, const std::array<double, 2>& b,
                  const std::array<double, 2>& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

double twice_area(const Plane& polygon) {
  double sum = 0.0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    sum += twice_area(polygon[0], polygon[i], polygon[i + 1]);
  }
  return sum;
}

std::vector<std::int32_t> split(const Plane& polygon, int axis = 2, double scale = 1.0) {
  std::vector<double> coordinates;
  for (const auto& [x, y] : polygon) {
    std::array<double, 3> p{};
    p[static_cast<std::size_t>((axis + 1) % 3)] = x * scale;
    p[static_cast<std::size_t>((axis + 2) % 3)] = y * scale;
    p[static_cast<std::size_t>(axis)] = 0.25 * scale;
    coordinates.insert(coordinates.end(), p.begin(), p.end());
  }
  std::vector<std::int32_t> corners(polygon.size());
  std::iota(corners.begin(), corners.end(), 0);
  std::vector<std::int32_t> triangles;
  EXPECT_TRUE(Triangulator(coordinates).split(corners, triangles));
  return triangles;
}

// n - 2 triangles, all turned as the polygon, whose areas add up.
void expect_tiled(const Plane& polygon) {
  const double whole = twice_area(polygon);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double scale : {1.0, 1e-150, 1e150}) {
      const auto triangles = split(polygon, axis, scale);
      ASSERT_EQ(triangles.size(), 3 * (polygon.size() - 2));
      double sum = 0.0;
      for (std::size_t t = 0; t < triangles.size(); t += 3) {
        const double area = twice_area(polygon[static_cast<std::size_t>(triangles[t])],
                                       polygon[static_cast<std::size_t>(triangles[t + 1])],
                                       polygon[static_cast<std::size_t>(triangles[t + 2])]);
        EXPECT_GE(area * whole, 0.0);
        sum += area;
      }
      EXPECT_NEAR(sum, whole, 1e-12 * std::abs(whole));
    }
  }
}

Plane reversed(Plane polygon) {
  std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

Plane star(int corners, double inner) {
  Plane polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners;
    const double radius = i % 2 == 0 ? 1.0 : inner;
    polygon.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return polygon;
}

TEST(Triangulator, MakesAFanOfAConvexPolygon) {
  EXPECT_EQ(split({{0, 0}, {1, 0}, {1, 1}, {0, 1}}), (std::vector<std::int32_t>{0, 1, 2, 0, 2, 3}));
  expect_tiled(star(64, 1.0));
  expect_tiled(reversed(star(64, 1.0)));
}

TEST(Triangulator, TilesConcavePolygonsFromEveryCorner) {
  for (const Plane& shape :
       {Plane{{0, 0}, {4, 0}, {1, 1}, {0, 4}},
        Plane{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, star(18, 0.4), star(200, 0.1)}) {
    Plane polygon = shape;
    for (std::size_t start = 0; start < std::min<std::size_t>(shape.size(), 6); ++start) {
      expect_tiled(polygon);
      expect_tiled(reversed(polygon));
      std::rotate(polygon.begin(), polygon.begin() + 1, polygon.end());
    }
  }
}

TEST(Triangulator, AllowsStraightCorners) {
  expect_tiled({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {0, 1}});
  expect_tiled({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {0, 1}});
}

TEST(Triangulator, TilesRandomMonotonePolygons) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> height(0.1, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    Plane polygon;
    const int n = 3 + trial % 20;
    for (int i = 0; i < n; ++i) polygon.push_back({double(i), -height(random)});
    for (int i = n; i-- > 0;) polygon.push_back({double(i), height(random)});
    expect_tiled(polygon);
  }
}

TEST(Triangulator, GivesSelfCrossingAndFlatPolygonsTheirNumberOfTriangles) {
  EXPECT_EQ(split({{0, 0}, {1, 1}, {1, 0}, {0, 1}}).size(), 6U);
  EXPECT_EQ(split({{0, 0}, {2, 2}, {2, 0}, {0, 1}, {3, 3}, {-1, 2}}).size(), 12U);
  EXPECT_EQ(split({{0, 0}, {1, 0}, {2, 0}, {3, 0}}).size(), 6U);
  EXPECT_EQ(split({{0, 0}, {0, 0}, {0, 0}, {0, 0}, {0, 0}}).size(), 9U);
  // Round twice: every turn goes left, and yet it is not convex.
  EXPECT_EQ(
      split({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {-.1, -.1}, {1.1, 0}, {1.1, 1.1}, {0, 1.1}}).size(),
      18U);
}

TEST(Triangulator, StaysFastAndSaysSoWhenAPolygonIsTooLarge) {
  const Plane polygon = star(60000, 0.99999);
  std::vector<double> coordinates;
  for (const auto& [x, y] : polygon) coordinates.insert(coordinates.end(), {x, y, 0.0});
  std::vector<std::int32_t> corners(polygon.size());
  std::iota(corners.begin(), corners.end(), 0);
  std::vector<std::int32_t> triangles;
  Triangulator triangulator(coordinates);
  EXPECT_FALSE(triangulator.split(corners, triangles));
  EXPECT_EQ(triangles.size(), 3 * (polygon.size() - 2));
}

}  // namespace
}  // namespace timbre::detail
