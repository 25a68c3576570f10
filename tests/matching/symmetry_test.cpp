#include "timbre/matching/symmetry.h"

#include <gtest/gtest.h>

#include "timbre/tests/support/shapes.h"

namespace timbre {
namespace {

const SurfaceOptions kSmall = {.eigenpairs = 120, .samples = 800, .geodesic_samples = 300};

TEST(FindReflections, FindsTheMirrorPlaneOfALump) {
  const TriangleMesh mesh = make_mirrored_lump(12);
  const MatchSurface s =
      prepare_surface(renumbered(mesh, random_order(mesh.vertices.rows(), 2)), kSmall);
  const std::vector<Reflection> found = find_reflections(s);
  ASSERT_FALSE(found.empty());
  double error = 0.0;
  for (Eigen::Index i = 0; i < s.points.rows(); ++i) {
    Eigen::RowVector3d mirror = s.points.row(i);
    mirror[0] *= -1.0;
    error += (s.points.row(found[0].map[static_cast<std::size_t>(i)]) - mirror).norm();
  }
  EXPECT_LT(error / static_cast<double>(s.points.rows()), 0.02);
  EXPECT_LT(found[0].involution, 0.02);
  EXPECT_LT((found[0].C - found[0].C.transpose()).norm(), 1e-12);
}

TEST(FindReflections, AreTheSameForAnyNumberOfThreads) {
  const MatchSurface s = prepare_surface(make_mirrored_lump(8), kSmall);
  const std::vector<Reflection> one = find_reflections(s, {.threads = 1});
  const std::vector<Reflection> two = find_reflections(s, {.threads = 2});
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].map, two[i].map);
    EXPECT_EQ(one[i].energy, two[i].energy);
  }
}

}  // namespace
}  // namespace timbre
