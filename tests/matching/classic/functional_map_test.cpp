#include "timbre/matching/classic/functional_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "timbre/analysis/core/error.h"
#include "timbre/datasets/creatures.h"
#include "timbre/tests/support/shapes.h"

namespace timbre {
namespace {

const SurfaceOptions kSmall = {.eigenpairs = 120, .samples = 800, .geodesic_samples = 300};

// A dog and itself, turned to its other side or not, under other numbers.
class BaselineOfACreature : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const CreatureBody body = make_creature_body("dog", {.vertices = 3000});
    const TriangleMesh& mesh = body.skin.rest;
    mirror_ = body.skin.mirror;
    order_ = random_order(mesh.vertices.rows(), 3);
    a_ = prepare_surface(mesh, kSmall);
    b_ = prepare_surface(renumbered(mesh, order_), kSmall);
  }

  // Distance in space, at unit area, from the image of a vertex to that of another.
  static double distance(const PointMap& map, std::size_t v, std::int32_t other) {
    const std::int32_t right = order_[static_cast<std::size_t>(other)];
    return (b_.points.row(map[v]) - b_.points.row(right)).norm();
  }

  static std::vector<std::int32_t> mirror_, order_;
  static MatchSurface a_, b_;
};
std::vector<std::int32_t> BaselineOfACreature::mirror_, BaselineOfACreature::order_;
MatchSurface BaselineOfACreature::a_, BaselineOfACreature::b_;

// Nothing ties the side of a limb to that of another.
TEST_F(BaselineOfACreature, FindsEachVertexOrItsMirrorImage) {
  const PointMap map = match_by_descriptors(a_, b_);
  ASSERT_EQ(map.size(), order_.size());
  ASSERT_GE(*std::min_element(map.begin(), map.end()), 0);
  double sum = 0.0;
  double direct = 0.0;
  double across = 0.0;
  for (std::size_t v = 0; v < map.size(); ++v) {
    const double right = distance(map, v, static_cast<std::int32_t>(v));
    const double wrong = distance(map, v, mirror_[v]);
    sum += std::min(right, wrong);
    direct += right;
    across += wrong;
  }
  const auto n = static_cast<double>(map.size());
  EXPECT_LT(sum / n, 0.005);
  EXPECT_LT(std::min(direct, across) / n, 0.05);
}

TEST_F(BaselineOfACreature, IsTheSameForAnyNumberOfThreads) {
  EXPECT_EQ(match_by_descriptors(a_, b_, {.threads = 1}),
            match_by_descriptors(a_, b_, {.threads = 2}));
}

TEST(MatchByDescriptors, MapsAShapeWithoutSymmetryOntoItself) {
  const MatchSurface s = prepare_surface(make_lump(8), kSmall);
  const PointMap map = match_by_descriptors(s, s);
  for (std::size_t v = 0; v < map.size(); ++v) EXPECT_EQ(map[v], static_cast<std::int32_t>(v));
}

TEST(MatchByDescriptors, WorksWithFewerEigenpairsThanItsStepsName) {
  const MatchSurface s = prepare_surface(make_lump(6), {.eigenpairs = 12});
  EXPECT_EQ(match_by_descriptors(s, s).size(), static_cast<std::size_t>(s.file_vertices));
}

std::string refusal(const DescriptorMapOptions& options) {
  static const MatchSurface s = prepare_surface(make_lump(4), {.eigenpairs = 40});
  try {
    (void)match_by_descriptors(s, s, options);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_request);
    return error.what();
  }
  return "no error";
}

TEST(MatchByDescriptors, RefusesOptionsThatMakeNoSense) {
  EXPECT_EQ(refusal({.functions = 2}), "functions: is 2; at least 3 is needed");
  EXPECT_EQ(refusal({.energies = 1}), "energies: is 1; at least 2 is needed");
  EXPECT_EQ(refusal({.laplacian = -0.01}), "laplacian: is -0.01; a finite number >= 0 is needed");
  EXPECT_EQ(refusal({.laplacian = std::numeric_limits<double>::quiet_NaN()}),
            "laplacian: is nan; a finite number >= 0 is needed");
}

}  // namespace
}  // namespace timbre
