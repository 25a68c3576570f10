#include "timbre/analysis/spectrum/detail/spectrum_slicing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
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
    SpectrumSlicer slicer(op.stiffness, op.mass, nullptr,
                          {.count = count, .half = 15, .width = GetParam()});
    while (!slicer.is_done()) slicer.advance();
    const Eigen::Index found = slicer.state().certain;
    ASSERT_GE(found, count);
    EXPECT_EQ(found, std::count_if(exact.begin(), exact.end(),
                                   [&](double x) { return x < slicer.state().bound; }));
    for (Eigen::Index i = 0; i < found; ++i) {
      ASSERT_NEAR(slicer.pairs().value(i), exact[static_cast<std::size_t>(i)], 1e-7)
          << count << ' ' << i;
    }
    const auto vectors = slicer.pairs().vectors(0, found);
    const Eigen::MatrixXd gram = vectors.transpose() * (op.mass * vectors);
    EXPECT_TRUE(gram.isIdentity(1e-8)) << count;
  }
}

TEST(SpectrumSlicer, FindsTheWholeSpectrumToItsEnd) {
  constexpr int kSide = 34;
  const IntrinsicMesh torus = make_flat_torus(kSide);
  const Operator op = compute_operator(torus.faces, torus.lengths, torus.vertices);
  const std::vector<double> exact = torus_eigenvalues(kSide);
  SpectrumSlicer slicer(op.stiffness, op.mass, nullptr, {.count = kSide * kSide, .half = 50});
  while (!slicer.is_done()) slicer.advance();
  ASSERT_EQ(slicer.state().certain, kSide * kSide);
  EXPECT_EQ(slicer.state().bound, std::numeric_limits<double>::infinity());
  for (Eigen::Index i = 0; i < kSide * kSide; ++i) {
    ASSERT_NEAR(slicer.pairs().value(i), exact[static_cast<std::size_t>(i)], 1e-6) << i;
  }
}

TEST(SpectrumSlicer, GoesOnWhenMoreIsWanted) {
  constexpr int kSide = 30;
  const IntrinsicMesh torus = make_flat_torus(kSide);
  const Operator op = compute_operator(torus.faces, torus.lengths, torus.vertices);
  const std::vector<double> exact = torus_eigenvalues(kSide);
  SpectrumSlicer slicer(op.stiffness, op.mass, nullptr, {.count = 30, .half = 15});
  Eigen::Index seen = 0;
  for (int count = 30; count <= 130; count += 25) {
    slicer.want(count);
    while (!slicer.is_done()) slicer.advance();
    for (; seen < slicer.state().certain; ++seen) {
      ASSERT_NEAR(slicer.pairs().value(seen), exact[static_cast<std::size_t>(seen)], 1e-7);
    }
    slicer.forget_before(seen);
    EXPECT_LE(slicer.pairs().end() - slicer.pairs().first(), 60);
  }
}

INSTANTIATE_TEST_SUITE_P(Blocks, EveryWidth, testing::Values(8, 16));

}  // namespace
}  // namespace timbre::detail
