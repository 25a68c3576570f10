#include "timbre/matching/refinement.h"

#include <gtest/gtest.h>

namespace timbre {
namespace {

RowMatrixXf numbers(Eigen::Index rows, Eigen::Index cols, unsigned seed) {
  std::srand(seed);  // NOLINT(cert-msc51-cpp): Eigen's Random draws from it
  return RowMatrixXf::Random(rows, cols);
}

PointMap brute_force(const RowMatrixXf& X, const RowMatrixXf& Y) {
  PointMap nearest;
  for (const auto& x : X.rowwise()) {
    Eigen::Index best = 0;
    (Y.rowwise() - x).rowwise().squaredNorm().minCoeff(&best);
    nearest.push_back(static_cast<std::int32_t>(best));
  }
  return nearest;
}

TEST(NearestRows, AreThoseOfBruteForceBothWaysForAnyThreads) {
  const RowMatrixXf X = numbers(777, 13, 1);
  const RowMatrixXf Y = numbers(501, 13, 2);
  for (const int threads : {1, 3}) {
    EXPECT_EQ(nearest_rows(X, Y, threads), brute_force(X, Y));
    const PointMaps both = nearest_rows_both_ways(X, Y, threads);
    EXPECT_EQ(both.ab, brute_force(X, Y));
    EXPECT_EQ(both.ba, brute_force(Y, X));
  }
}

TEST(NearestRows, GoToTheSmallerIndexWhereRowsAreEqual) {
  RowMatrixXf Y = RowMatrixXf::Zero(40, 3);
  const RowMatrixXf X = RowMatrixXf::Ones(3, 3);
  EXPECT_EQ(nearest_rows(X, Y, 1), PointMap(3, 0));
  EXPECT_EQ(nearest_rows_both_ways(X, Y, 2).ba, PointMap(40, 0));
}

TEST(FitFunctionalMap, RecoversTheMatrixThatMadeTheValues) {
  const Eigen::MatrixXd phi = numbers(200, 8, 3).cast<double>();
  const Eigen::MatrixXd C = numbers(8, 5, 4).cast<double>();
  const Eigen::VectorXd weight = Eigen::VectorXd::LinSpaced(200, 0.5, 2.0);
  EXPECT_LT((fit_functional_map(phi, weight, phi * C) - C).norm(), 1e-5);
}

}  // namespace
}  // namespace timbre
