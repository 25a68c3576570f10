#include "timbre/analysis/geodesic/batch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/geodesic/exact.h"
#include "timbre/analysis/geodesic/heat.h"
#include "timbre/datasets/analytic.h"
#include "timbre/tests/support/shapes.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

const std::vector<std::vector<std::int32_t>> kSets = {{3}, {10, 20, 30}, {}, {7}, {3}};

class DistancesByAnyMethod : public testing::TestWithParam<DistanceMethod> {};

TEST_P(DistancesByAnyMethod, AreTheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = make_lump(6);
  const MatrixXd one = compute_distances(mesh, kSets, {.method = GetParam(), .threads = 1});
  ASSERT_EQ(one.cols(), 5);
  EXPECT_EQ(one, compute_distances(mesh, kSets, {.method = GetParam(), .threads = 4}));
  EXPECT_EQ(one.col(0), one.col(4));
  EXPECT_EQ(one(3, 0), 0.0);
  EXPECT_TRUE(one.col(2).array().isInf().all());
}

TEST_P(DistancesByAnyMethod, StopWhenAskedToOnTheCallersThread) {
  const TriangleMesh mesh = make_lump(6);
  const std::thread::id here = std::this_thread::get_id();
  int asked = 0;
  const Progress stop = [&](const ProgressStep& step) {
    EXPECT_EQ(std::this_thread::get_id(), here);
    EXPECT_EQ(step.total, 5);
    ++asked;
    return false;
  };
  try {
    (void)compute_distances(mesh, kSets, {.method = GetParam(), .threads = 3, .progress = stop});
    FAIL() << "no exception";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::cancelled);
  }
  EXPECT_EQ(asked, 1);
}
INSTANTIATE_TEST_SUITE_P(Methods, DistancesByAnyMethod,
                         testing::Values(DistanceMethod::exact, DistanceMethod::heat,
                                         DistanceMethod::graph),
                         [](const auto& of) { return std::string(to_word(of.param)); });

TEST(ComputeDistances, AreThoseOfTheMethods) {
  const TriangleMesh mesh = make_lump(6);
  EXPECT_EQ(compute_distances(mesh, kSets).col(1),
            exact_distances(make_geodesic_mesh(mesh), kSets[1]));
  EXPECT_EQ(compute_distances(mesh, kSets, {.method = DistanceMethod::heat}).col(1),
            HeatGeodesics(mesh).distances(kSets[1]));
  EXPECT_EQ(compute_distances(mesh, kSets, {.method = DistanceMethod::graph}).col(1),
            graph_distances(make_geodesic_graph(mesh), kSets[1]));
}

TEST(ComputeDistances, ComeInBlocksOfBoundedSize) {
  const TriangleMesh mesh = make_rectangle(1, 1, 150, 150);
  const std::vector<std::vector<std::int32_t>> sets(900, {5});
  Index next = 0;
  Index blocks = 0;
  compute_distances(mesh, sets,
                    [&](Index first, const Eigen::Ref<const MatrixXd>& columns) {
                      EXPECT_EQ(first, next);
                      EXPECT_LE(columns.size() * 8, Index{64} << 20);
                      next += columns.cols();
                      ++blocks;
                    },
                    {.method = DistanceMethod::graph});
  EXPECT_EQ(next, 900);
  EXPECT_GT(blocks, 1);
}

TEST(ComputeDistances, RefuseAVertexThatDoesNotExistBeforeAnyWork) {
  const TriangleMesh mesh = make_rectangle(1, 1, 1, 1);
  const std::vector<std::vector<std::int32_t>> sets = {{0}, {1, 4}};
  try {
    compute_distances(mesh, sets, [](Index, const auto&) { ADD_FAILURE() << "work was done"; });
    FAIL() << "no exception";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "sources: vertex 4 does not exist; the mesh has 4");
  }
}

TEST(ComputeDistances, OfNoSetsAreNone) {
  EXPECT_EQ(compute_distances(make_rectangle(1, 1, 1, 1), {}).cols(), 0);
}

}  // namespace
}  // namespace timbre
