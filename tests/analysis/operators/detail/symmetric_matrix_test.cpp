#include "timbre/analysis/operators/detail/symmetric_matrix.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <random>
#include <vector>

namespace timbre::detail {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<MatrixPair> random_pairs(int n, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::int32_t> vertex(0, n - 1);
  std::normal_distribution<double> value;
  std::vector<MatrixPair> pairs;
  for (int i = 0; i < count; ++i) pairs.push_back({vertex(random), vertex(random), value(random)});
  return pairs;
}

TEST(SymmetricMatrix, AddsUpPairsAndTheDiagonal) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const std::vector<MatrixPair> pairs = random_pairs(12, 60, seed);
    const VectorXd diagonal = VectorXd::LinSpaced(12, -1.0, 2.0);
    MatrixXd expected = diagonal.asDiagonal();
    for (const auto& [a, b, value] : pairs) {
      expected(a, b) += value;
      if (a != b) expected(b, a) += value;
    }
    const SparseMatrix found = symmetric_matrix(pairs, diagonal);
    EXPECT_LT((MatrixXd(found) - expected).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_EQ(MatrixXd(found), MatrixXd(found).transpose());
    EXPECT_TRUE(found.isCompressed());
    for (Eigen::Index j = 0; j < 12; ++j) {
      Eigen::Index last = -1;
      for (SparseMatrix::InnerIterator it(found, j); it; ++it) {
        EXPECT_GT(it.row(), last);
        last = it.row();
      }
    }
  }
}

TEST(LaplacianOfEdges, IsTheSumOfSquaredDifferences) {
  const std::vector<MatrixPair> edges = random_pairs(10, 40, 7);
  const VectorXd u = VectorXd::Random(10);
  double expected = 0.0;
  for (const auto& [a, b, w] : edges) expected += w * (u[a] - u[b]) * (u[a] - u[b]);
  const SparseMatrix W = laplacian_of_edges(edges, 10);
  EXPECT_NEAR(u.dot(W * u), expected, 1e-12);
  EXPECT_LT((W * VectorXd::Ones(10)).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(LaplacianOfEdges, LeavesRowsWithoutEdgesEmpty) {
  const SparseMatrix W = laplacian_of_edges({{0, 2, 1.0}, {3, 3, 5.0}}, 5);
  EXPECT_EQ(W.nonZeros(), 4);
}

}  // namespace
}  // namespace timbre::detail
