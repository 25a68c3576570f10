#include "timbre/matching/match.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/operators/operator.h"
#include "timbre/tests/support/shapes.h"

namespace timbre {
namespace {

constexpr int kFrequency = 12;
const SurfaceOptions kSmall = {.eigenpairs = 120, .samples = 800, .geodesic_samples = 300};

TriangleMesh turned(const TriangleMesh& mesh) {
  TriangleMesh result = mesh;
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  result.vertices = 3.0 * mesh.vertices * R.transpose();
  result.vertices.array() += 7.0;
  return result;
}

// Mean distance in space, at unit area, between a map and the truth.
double error_of(const PointMap& map, const std::vector<std::int32_t>& truth,
                const MatchSurface& target) {
  double sum = 0.0;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (map[i] < 0) return 1.0;
    sum += (target.points.row(map[i]) - target.points.row(truth[i])).norm();
  }
  return sum / static_cast<double>(map.size());
}

class MatchOfALump : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    mesh_ = make_lump(kFrequency);
    order_ = random_order(mesh_.vertices.rows(), 5);
    copy_ = renumbered(turned(mesh_), order_);
    a_ = prepare_surface(mesh_, kSmall);
    b_ = prepare_surface(copy_, kSmall);
  }
  static TriangleMesh mesh_, copy_;
  static std::vector<std::int32_t> order_;
  static MatchSurface a_, b_;
};
TriangleMesh MatchOfALump::mesh_, MatchOfALump::copy_;
std::vector<std::int32_t> MatchOfALump::order_;
MatchSurface MatchOfALump::a_, MatchOfALump::b_;

TEST_F(MatchOfALump, FindsEachVertexOfATurnedAndRenumberedCopy) {
  const MatchResult result = match(a_, b_);
  EXPECT_EQ(result.verdict, Verdict::clear) << result.reason;
  EXPECT_EQ(result.solutions[0].orientation, MapOrientation::direct);
  EXPECT_EQ(result.ab, order_);
  EXPECT_GT(result.solutions[0].coverage, 0.99);
  for (std::size_t i = 0; i < order_.size(); ++i) {
    EXPECT_EQ(result.ba[static_cast<std::size_t>(order_[i])], static_cast<std::int32_t>(i));
  }
}

TEST_F(MatchOfALump, HoldsAMirroredRival) {
  const MatchResult result = match(a_, b_);
  EXPECT_TRUE(std::any_of(result.solutions.begin(), result.solutions.end(),
                          [](const auto& s) { return s.orientation == MapOrientation::mirrored; }));
}

TEST_F(MatchOfALump, IsTheSameForAnyNumberOfThreads) {
  const MatchResult one = match(a_, b_, {.threads = 1});
  const MatchResult two = match(a_, b_, {.threads = 2});
  EXPECT_EQ(one.ab, two.ab);
  EXPECT_EQ(one.solutions[0].energy, two.solutions[0].energy);
  EXPECT_EQ(one.solutions[0].functional.ab, two.solutions[0].functional.ab);
  SurfaceOptions options = kSmall;
  options.threads = 2;
  const MatchSurface again = prepare_surface(mesh_, options);
  options.threads = 1;
  const MatchSurface once = prepare_surface(mesh_, options);
  EXPECT_EQ(again.vectors, once.vectors);
  EXPECT_EQ(again.distances, once.distances);
}

TEST_F(MatchOfALump, DoesNotDependOnSignsOfEigenfunctions) {
  Spectrum spectrum = compute_spectrum(compute_operator(copy_), {.count = 120});
  std::mt19937 random(11);
  for (Eigen::Index j = 1; j < spectrum.vectors.cols(); ++j) {
    if (random() % 2 == 0) spectrum.vectors.col(j) *= -1.0;
  }
  const MatchResult result = match(a_, prepare_surface(copy_, spectrum, kSmall));
  EXPECT_EQ(result.ab, order_);
  EXPECT_FALSE(result.switches.empty());
}

TEST_F(MatchOfALump, DoesNotDependOnRotationsWithinNearEqualEigenvalues) {
  Spectrum spectrum = compute_spectrum(compute_operator(copy_), {.count = 120});
  int rotated = 0;
  for (Eigen::Index j = 1; j + 1 < spectrum.values.size(); ++j) {
    if (spectrum.values[j + 1] > 1.02 * spectrum.values[j]) continue;
    const double angle = 0.7 + 0.1 * static_cast<double>(j);
    const Eigen::VectorXd first = spectrum.vectors.col(j);
    const Eigen::VectorXd second = spectrum.vectors.col(j + 1);
    spectrum.vectors.col(j) = std::cos(angle) * first + std::sin(angle) * second;
    spectrum.vectors.col(j + 1) = std::cos(angle) * second - std::sin(angle) * first;
    ++rotated;
    ++j;
  }
  ASSERT_GT(rotated, 10);
  const MatchResult result = match(a_, prepare_surface(copy_, spectrum, kSmall));
  EXPECT_LT(error_of(result.ab, order_, b_), 1e-3);
}

TEST_F(MatchOfALump, RecognisesAMirrorImage) {
  TriangleMesh image = copy_;
  image.vertices.col(0) *= -1.0;
  const MatchResult result = match(a_, prepare_surface(image, kSmall));
  EXPECT_EQ(result.solutions[0].orientation, MapOrientation::mirrored);
  EXPECT_LT(error_of(result.ab, order_, b_), 1e-3);
}

TEST(Match, SaysThatAnOpenSurfaceHasNoLeftAndRight) {
  TriangleMesh open = make_lump(10);
  open.faces.conservativeResize(open.faces.rows() - 40, 3);
  open.faces.conservativeResize(open.faces.rows() / 2, 3);
  const MatchSurface s = prepare_surface(open, kSmall);
  EXPECT_EQ(s.orientation, Orientation::consistent);
  const MatchResult result = match(s, s);
  EXPECT_EQ(result.verdict, Verdict::ambiguous);
  EXPECT_EQ(result.solutions[0].orientation, MapOrientation::unknown);
}

TEST(Match, DoesNotClaimToMapASphere) {
  const MatchSurface s = prepare_surface(make_sphere(10), kSmall);
  TriangleMesh other = renumbered(make_sphere(10), random_order(1002, 3));
  const MatchResult result = match(s, prepare_surface(other, kSmall));
  EXPECT_EQ(result.verdict, Verdict::ambiguous);
  EXPECT_EQ(result.reason, "eigenvalues come in groups: a shape can be turned onto itself");
}

TEST(Match, LeavesOtherComponentsAndUnusedVerticesUnmatched) {
  const TriangleMesh lump = make_lump(8);
  const TriangleMesh small = make_sphere(2);
  const Eigen::Index n = lump.vertices.rows();
  const Eigen::Index k = small.vertices.rows();
  TriangleMesh mesh;
  mesh.vertices.resize(n + k + 1, 3);
  mesh.vertices << lump.vertices, 0.05 * small.vertices, Eigen::RowVector3d::Constant(9.0);
  mesh.faces.resize(lump.faces.rows() + small.faces.rows(), 3);
  mesh.faces << lump.faces, (small.faces.array() + static_cast<std::int32_t>(n)).matrix();
  const MatchSurface s = prepare_surface(mesh, kSmall);
  const MatchResult result = match(s, s);
  ASSERT_EQ(result.ab.size(), static_cast<std::size_t>(n + k + 1));
  EXPECT_GE(*std::min_element(result.ab.begin(), result.ab.begin() + n), 0);
  EXPECT_EQ(*std::max_element(result.ab.begin() + n, result.ab.end()), -1);
}

TEST(Match, DoesNotFeelAFarOriginOrTheWindingOfFaces) {
  const TriangleMesh mesh = make_lump(8);
  const MatchSurface here = prepare_surface(mesh, kSmall);
  TriangleMesh there = mesh;
  there.vertices.array() += 1e6;
  for (Eigen::Index f = 0; f < there.faces.rows(); f += 3) {
    std::swap(there.faces(f, 1), there.faces(f, 2));
  }
  std::vector<std::int32_t> same(static_cast<std::size_t>(mesh.vertices.rows()));
  std::iota(same.begin(), same.end(), 0);
  const MatchResult result = match(here, prepare_surface(there, kSmall));
  EXPECT_EQ(result.verdict, Verdict::clear) << result.reason;
  EXPECT_LT(error_of(result.ab, same, here), 1e-3);
}

TEST(Match, RefusesOptionsThatMakeNoSense) {
  const TriangleMesh mesh = make_lump(4);
  EXPECT_THROW((void)prepare_surface(mesh, {.eigenpairs = 1}), Error);
  EXPECT_THROW((void)prepare_surface(mesh, {.geodesic_samples = 0}), Error);
  EXPECT_THROW((void)prepare_surface(mesh, {.tensor_size = -1}), Error);
  const MatchSurface s = prepare_surface(mesh, {.eigenpairs = 40});
  try {
    (void)match(s, s, {.rivals = 0});
    FAIL() << "no exception";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "rivals: is 0; at least 1 is needed");
  }
}

TEST(Match, StopsWhenToldTo) {
  const MatchSurface s = prepare_surface(make_lump(6), {.eigenpairs = 60});
  try {
    (void)match(s, s, {.progress = [](const ProgressStep&) { return false; }});
    FAIL() << "no exception";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::cancelled);
  }
}

}  // namespace
}  // namespace timbre
