#include "timbre/analysis/spectrum/detail/spectrum_slicing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "timbre/analysis/operators/operator.h"
#include "timbre/datasets/analytic.h"

namespace timbre::detail {
namespace {

// Of a flat torus of n x n squares with side 1, ascending: multiplicities of 4 and 8.
std::vector<double> torus_eigenvalues(int n) {
  std::vector<double> all;
  const auto part = [n](int i) { return 2.0 - 2.0 * std::cos(2.0 * std::numbers::pi * i / n); };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) all.push_back(n * n * (part(i) + part(j)));
  }
  std::sort(all.begin(), all.end());
  return all;
}

class EveryWidth : public testing::TestWithParam<int> {};

TEST_P(EveryWidth, FindsAllCopiesWhereverTheListEnds) {
  constexpr int kSide = 24;
  const IntrinsicMesh torus = make_flat_torus(kSide);
  const Operator op = compute_operator(torus.faces, torus.lengths, torus.vertices);
  const std::vector<double> exact = torus_eigenvalues(kSide);
  for (const int count : {20, 21, 23, 30, 31, 33, 40, 60, 70}) {
    const SlicedPairs found = lowest_pairs(op.stiffness, op.mass, nullptr,
                                           {.count = count, .half = 15, .width = GetParam()});
    ASSERT_GE(found.values.size(), count);
    EXPECT_EQ(found.values.size(),
              std::count_if(exact.begin(), exact.end(), [&](double x) { return x < found.bound; }));
    for (Eigen::Index i = 0; i < found.values.size(); ++i) {
      ASSERT_NEAR(found.values[i], exact[static_cast<std::size_t>(i)], 1e-7) << count << ' ' << i;
    }
    const Eigen::MatrixXd gram = found.vectors.transpose() * (op.mass * found.vectors);
    EXPECT_TRUE(gram.isIdentity(1e-8)) << count;
  }
}

INSTANTIATE_TEST_SUITE_P(Blocks, EveryWidth, testing::Values(8, 16));

}  // namespace
}  // namespace timbre::detail
