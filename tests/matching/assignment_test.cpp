#include "timbre/matching/assignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <vector>

#include "timbre/tests/support/refused_request.h"

namespace timbre {
namespace {

using Eigen::MatrixXd;

double sum_of(const MatrixXd& profit, const std::vector<int>& column) {
  double sum = 0.0;
  for (std::size_t i = 0; i < column.size(); ++i) {
    sum += profit(static_cast<Eigen::Index>(i), column[i]);
  }
  return sum;
}

// All ways to give rows different columns.
double best_of_all(const MatrixXd& profit) {
  std::vector<int> order(static_cast<std::size_t>(profit.cols()));
  std::iota(order.begin(), order.end(), 0);
  double best = -1e300;
  do {
    const std::vector<int> first(order.begin(), order.begin() + profit.rows());
    best = std::max(best, sum_of(profit, first));
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

TEST(BestAssignment, IsTheBestOfAll) {
  std::srand(1);
  for (int round = 0; round < 200; ++round) {
    const int rows = 1 + round % 6;
    const int columns = rows + round % 3;
    MatrixXd profit = MatrixXd::Random(rows, columns);
    if (round % 4 == 0) profit = (3.0 * profit).array().round();  // ties
    const std::vector<int> column = best_assignment(profit);
    EXPECT_EQ(std::set<int>(column.begin(), column.end()).size(), column.size());
    EXPECT_NEAR(sum_of(profit, column), best_of_all(profit), 1e-12);
  }
}

TEST(BestAssignment, FindsAPermutationOfManyAgain) {
  constexpr int kSize = 150;
  MatrixXd profit = MatrixXd::Random(kSize, kSize + 30).cwiseAbs();
  std::vector<int> expected(kSize);
  for (int i = 0; i < kSize; ++i) {
    expected[static_cast<std::size_t>(i)] = 7 * i % (kSize + 30);
    profit(i, expected[static_cast<std::size_t>(i)]) += 1.0;
  }
  EXPECT_EQ(best_assignment(profit), expected);
}

TEST(BestAssignment, RefusesMoreRowsThanColumns) {
  EXPECT_TRUE(best_assignment(MatrixXd(0, 3)).empty());
  EXPECT_EQ(refused_request([] { (void)best_assignment(MatrixXd::Zero(3, 2)); }),
            "assignment: 3 rows, only 2 columns");
}

}  // namespace
}  // namespace timbre
