#include "timbre/matching/surface.h"

#include <gtest/gtest.h>

#include "timbre/analysis/core/error.h"
#include "timbre/tests/support/shapes.h"

namespace timbre {
namespace {

TEST(PrepareSurface, TensorsHaveTheirSymmetries) {
  const MatchSurface s = prepare_surface(make_lump(10), {.eigenpairs = 60});
  ASSERT_EQ(s.products.size(), 20U);
  double largest = 0.0;
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_LT((s.products[i] - s.products[i].transpose()).norm(), 1e-10);
    EXPECT_LT((s.areas[i] + s.areas[i].transpose()).norm(), 1e-10);
    largest = std::max(largest, s.areas[i].norm());
    for (std::size_t j = 0; j < 20; ++j) {
      const auto a = static_cast<Eigen::Index>(i);
      const auto b = static_cast<Eigen::Index>(j);
      EXPECT_NEAR(s.products[i](b, 3), s.products[3](a, b), 1e-10);
      EXPECT_NEAR(s.areas[i](b, 3), s.areas[3](a, b), 1e-10);
    }
  }
  EXPECT_GT(largest, 1.0);
}

TEST(PrepareSurface, IsAtUnitAreaAroundTheOrigin) {
  TriangleMesh mesh = make_lump(8);
  mesh.vertices *= 250.0;
  mesh.vertices.array() += 1000.0;
  const MatchSurface s = prepare_surface(mesh, {.eigenpairs = 40});
  EXPECT_NEAR(s.mass.sum(), 1.0, 1e-12);
  EXPECT_LT((s.mass.transpose() * s.points).norm(), 1e-9);
  EXPECT_NEAR(s.curvature.norm(), 1.0, 0.2);
  EXPECT_NEAR(s.sample_mass.sum(), 1.0, 1e-5);
  EXPECT_EQ(s.orientation, Orientation::outward);
}

TEST(PrepareSurface, SamplesNeverRepeat) {
  const MatchSurface s =
      prepare_surface(make_lump(6), {.eigenpairs = 40, .samples = 300, .geodesic_samples = 100});
  std::vector<std::int32_t> sorted = s.samples;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(sorted.size(), 300U);
  EXPECT_EQ(std::adjacent_find(sorted.begin(), sorted.end()), sorted.end());
}

TEST(PrepareSurface, TakesTheLargestComponentAndRemembersTheFile) {
  const TriangleMesh small = make_sphere(2);
  const TriangleMesh large = make_lump(6);
  TriangleMesh both;
  both.vertices.resize(small.vertices.rows() + large.vertices.rows(), 3);
  both.vertices << small.vertices, large.vertices;
  both.faces.resize(small.faces.rows() + large.faces.rows(), 3);
  both.faces << small.faces,
      (large.faces.array() + static_cast<std::int32_t>(small.vertices.rows())).matrix();
  both.vertices.topRows(small.vertices.rows()) *= 0.1;
  const MatchSurface s = prepare_surface(both, {.eigenpairs = 40});
  EXPECT_EQ(s.file_vertices, both.vertices.rows());
  EXPECT_EQ(s.vertex.front(), small.vertices.rows());
  EXPECT_EQ(static_cast<Eigen::Index>(s.vertex.size()), large.vertices.rows());
  EXPECT_LT(s.component_share, 1.0);
}

TEST(PrepareSurface, RefusesAShapeTooSmallToMatch) {
  try {
    (void)prepare_surface(make_sphere(1));
    FAIL() << "no exception";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "mesh: its largest component has 12 vertices; matching needs 30");
  }
}

}  // namespace
}  // namespace timbre
