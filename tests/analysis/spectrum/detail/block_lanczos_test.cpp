#include "timbre/analysis/spectrum/detail/block_lanczos.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "timbre/analysis/operators/operator.h"
#include "timbre/datasets/analytic.h"

namespace timbre::detail {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNowhere = -std::numeric_limits<double>::infinity();

struct Problem {
  Operator op;
  VectorXd exact;
  std::unique_ptr<ShiftedFactor> factor;

  explicit Problem(Operator with) : op(std::move(with)) {
    const MatrixXd K = op.stiffness;
    const MatrixXd M = op.mass;
    exact = Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(K, M, Eigen::EigenvaluesOnly)
                .eigenvalues();
    factor = make_shifted_factor(op.stiffness, op.mass, nullptr, FactorizationBackend::supernodal);
  }

  // In the middle between two eigenvalues, with so many below.
  [[nodiscard]] double shift_above(Index count) const {
    return 0.5 * (exact[count - 1] + exact[count]);
  }
  // Error of the vectors in the equation, and of their products.
  void expect_pairs(const BlockLanczos& lanczos, const BandPairs& band, double tolerance) const {
    const auto count = static_cast<int>(band.values.size());
    MatrixXd X(op.mass.rows(), count);
    lanczos.write_vectors(0, count, X.data(), X.rows());
    const VectorXd values = VectorXd::Map(band.values.data(), count);
    const MatrixXd rest = op.stiffness * X - op.mass * X * values.asDiagonal();
    const MatrixXd scaled =
        VectorXd(op.mass * VectorXd::Ones(X.rows())).cwiseSqrt().cwiseInverse().asDiagonal() * rest;
    EXPECT_LT(scaled.colwise().norm().maxCoeff(), tolerance * values.cwiseAbs().maxCoeff());
    EXPECT_TRUE((X.transpose() * (op.mass * X)).isIdentity(1e-9));
  }
};

// Their order is that of the nearest eigenvalues, of which none is left out.
void expect_an_interval(const BandPairs& band, const VectorXd& exact, Index below) {
  ASSERT_EQ(static_cast<int>(band.values.size()), band.left + band.right);
  for (int i = 0; i < band.left + band.right; ++i) {
    const Index number = below - band.left + i;
    ASSERT_LT(number, exact.size());
    EXPECT_NEAR(band.values[static_cast<std::size_t>(i)], exact[number], 1e-8 * exact[below])
        << number;
  }
}

class EveryRun : public testing::TestWithParam<std::tuple<int, MassKind>> {};

TEST_P(EveryRun, FindsAnIntervalAroundTheShift) {
  const auto [width, kind] = GetParam();
  const Problem problem(compute_operator(make_ellipsoid(1.0, 1.3, 1.9, 8), {.mass = kind}));
  for (const Index below : {1, 12, 40}) {
    SCOPED_TRACE(below);
    const double shift = problem.shift_above(below);
    ASSERT_FALSE(problem.factor->factorize(shift).near_singular);
    BlockLanczos lanczos(*problem.factor, {.width = width});
    const BandGoal goal{kNowhere, static_cast<int>(below), 15, problem.exact[below]};
    const BandPairs band = lanczos.run(shift, goal);
    EXPECT_EQ(band.left, below);
    EXPECT_GE(band.right, 15);
    expect_an_interval(band, problem.exact, below);
    problem.expect_pairs(lanczos, band, 1e-8);

    const BandPairs more = lanczos.go_on(shift, {kNowhere, goal.left, 40, goal.scale});
    EXPECT_GE(more.right, 40);
    expect_an_interval(more, problem.exact, below);
  }
}

TEST_P(EveryRun, StopsAtTheCut) {
  const auto [width, kind] = GetParam();
  const Problem problem(compute_operator(make_ellipsoid(1.0, 1.3, 1.9, 8), {.mass = kind}));
  const double shift = problem.shift_above(30);
  ASSERT_FALSE(problem.factor->factorize(shift).near_singular);
  BlockLanczos lanczos(*problem.factor, {.width = width});
  const BandPairs band = lanczos.run(shift, {problem.shift_above(20), 10, 5, problem.exact[30]});
  EXPECT_EQ(band.left, 10);
  EXPECT_TRUE(band.sees_the_cut);
  expect_an_interval(band, problem.exact, 30);
}

INSTANTIATE_TEST_SUITE_P(Cases, EveryRun,
                         testing::Combine(testing::Values(8, 16),
                                          testing::Values(MassKind::lumped, MassKind::consistent)));

// Large enough for several pieces of rows, and subtrees of the factor, at once.
TEST(BlockLanczos, RepeatsItselfForASeedAndOnAnyThreads) {
  const TriangleMesh mesh = make_ellipsoid(1.0, 1.3, 1.9, 32);
  ASSERT_GT(mesh.vertices.rows(), 8192);
  const Operator op = compute_operator(mesh);
  const auto vectors = [&](int threads) {
    const auto factor = make_shifted_factor(op.stiffness, op.mass, &mesh.vertices,
                                            FactorizationBackend::supernodal, threads);
    constexpr double kShift = 9.0;
    EXPECT_FALSE(factor->factorize(kShift).near_singular);
    BlockLanczos lanczos(*factor, {.threads = threads});
    const BandPairs band = lanczos.run(kShift, {kNowhere, 5, 10, kShift});
    EXPECT_GE(band.right, 10);
    MatrixXd X(op.mass.rows(), 10);
    lanczos.write_vectors(0, 10, X.data(), X.rows());
    return X;
  };
  const MatrixXd one = vectors(1);
  EXPECT_EQ(vectors(1), one);
  EXPECT_EQ(vectors(3), one);
}

// Twenty, and 140 copies of each eigenvalue: the inverse leads nowhere after three blocks.
Problem few_eigenvalues() {
  constexpr int kSize = 300;
  Operator op;
  op.mass.resize(kSize, kSize);
  op.mass.setIdentity();
  op.stiffness = op.mass;
  for (int i = 0; i < kSize; ++i) op.stiffness.coeffRef(i, i) = i < 20 ? 1.0 : 4.0 + i % 2;
  return Problem(std::move(op));
}

TEST(BlockLanczos, GoesOnWhereTheInverseLeadsNowhere) {
  const Problem problem = few_eigenvalues();
  ASSERT_EQ(problem.factor->factorize(2.0).negative, 20);
  BlockLanczos lanczos(*problem.factor, {.width = 8});
  const BandPairs band = lanczos.run(2.0, {kNowhere, 20, 0, 3.0});
  EXPECT_EQ(band.left, 20);
  problem.expect_pairs(lanczos, band, 1e-9);
  for (const double value : band.values) EXPECT_NEAR(value, std::round(value), 1e-12);
}

TEST(BlockLanczos, FindsFurtherCopiesBesideThoseThatAreLocked) {
  const Problem problem = few_eigenvalues();
  ASSERT_EQ(problem.factor->factorize(2.0).negative, 20);
  BlockLanczos lanczos(*problem.factor, {.width = 8, .most_blocks = 3});
  std::vector<int> found;
  for (int left = 20; left > 0 && found.size() < 5; left -= found.back()) {
    const BandPairs band = lanczos.run(2.0, {kNowhere, left, 0, 3.0});
    ASSERT_GT(band.left, 0);
    problem.expect_pairs(lanczos, band, 1e-7);
    lanczos.lock(0, static_cast<int>(band.values.size()));
    found.push_back(band.left);
  }
  EXPECT_EQ(found, (std::vector<int>{8, 8, 4}));
  lanczos.unlock();
  EXPECT_EQ(lanczos.run(2.0, {kNowhere, 20, 0, 3.0}).left, 8);
}

TEST(BlockLanczos, GivesUpAtTheLargestBasisWithWhatItHas) {
  const Problem problem(compute_operator(make_ellipsoid(1.0, 1.3, 1.9, 8)));
  const double shift = problem.shift_above(100);
  ASSERT_FALSE(problem.factor->factorize(shift).near_singular);
  BlockLanczos lanczos(*problem.factor, {.width = 8, .most_blocks = 10});
  const BandPairs band = lanczos.run(shift, {kNowhere, 100, 100, problem.exact[100]});
  EXPECT_GT(band.left + band.right, 0);
  EXPECT_LT(band.left, 100);
  expect_an_interval(band, problem.exact, 100);
}

TEST(BlockLanczos, CountsItsSolvesAndStopsWhereItIsTold) {
  const Problem problem(compute_operator(make_ellipsoid(1.0, 1.3, 1.9, 8)));
  const double shift = problem.shift_above(20);
  ASSERT_FALSE(problem.factor->factorize(shift).near_singular);
  int solves = 0;
  BlockLanczos lanczos(*problem.factor, {.width = 8, .on_solve = [&](int width) {
                                           solves += width;
                                           if (solves >= 64) throw std::string("stop");
                                         }});
  EXPECT_THROW((void)lanczos.run(shift, {kNowhere, 20, 20, problem.exact[20]}), std::string);
  EXPECT_EQ(solves, 64);
}

}  // namespace
}  // namespace timbre::detail
