#include "timbre/analysis/spectrum/detail/diagonal_block.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <vector>

#include "timbre/analysis/spectrum/detail/aligned_array.h"
#include "timbre/tests/support/sparse_matrices.h"

namespace timbre::detail {
namespace {

using Eigen::MatrixXd;

struct Factor {
  std::vector<int> order;
  MatrixXd inverse, d_inverse;
  PivotCounts counts;
};

Factor factorize(const MatrixXd& A, InstructionSet set) {
  const auto width = static_cast<int>(A.rows());
  const int side = padded(width);
  const auto values = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
  AlignedArray block(values);
  AlignedArray work(values);
  AlignedArray tiles(values);
  Eigen::Map<MatrixXd> padded_block(block.data(), side, side);
  padded_block.setZero();
  padded_block.topLeftCorner(width, width).triangularView<Eigen::Lower>() = A;
  Factor f{
      std::vector<int>(A.rows()), MatrixXd::Zero(width, width), MatrixXd::Zero(width, width), {}};
  std::vector<double> scale(A.rows());
  for (int i = 0; i < width; ++i) scale[i] = A.row(i).cwiseAbs().maxCoeff();
  std::vector<double> d(A.rows());
  std::vector<double> e(A.rows());
  f.counts = factorize_block(tile_kernels(set), block.data(), width, scale.data(), work.data(),
                             {f.order.data(), d.data(), e.data(), tiles.data()});
  for (int i = 0; i < width; ++i) {
    for (int k = 0; k < width; ++k) {
      f.inverse(i, k) = tiles.data()[(i / kTile * side + k) * kTile + i % kTile];
    }
    f.d_inverse(i, i) = d[i];
    if (i + 1 < width) f.d_inverse(i + 1, i) = f.d_inverse(i, i + 1) = e[i];
  }
  return f;
}

MatrixXd random_symmetric(int n, unsigned seed) {
  const MatrixXd lower(random_where(n, seed, [](int, int) { return true; }));
  return lower.selfadjointView<Eigen::Lower>();
}

class EveryInstructionSet : public testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override {
    if (!has(GetParam())) GTEST_SKIP() << "not on this processor";
  }
};

// D^-1 = L^-1 P A P^T L^-T inverted: all that the solves rely on.
TEST_P(EveryInstructionSet, InverseFactorsDiagonalizeTheBlock) {
  for (int n = 1; n <= kPanelWidth; ++n) {
    MatrixXd A = random_symmetric(n, static_cast<unsigned>(n));
    if (n % 3 == 0) A.diagonal().setZero();
    const Factor f = factorize(A, GetParam());
    const MatrixXd mixed = A(f.order, f.order);
    const MatrixXd D = f.inverse * mixed * f.inverse.transpose();
    EXPECT_LT((D * f.d_inverse - MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff(), 1e-9) << n;
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(A, Eigen::EigenvaluesOnly);
    EXPECT_EQ(f.counts.negative, (solver.eigenvalues().array() < 0.0).count()) << n;
    EXPECT_EQ(f.counts.replaced, 0) << n;
  }
}

TEST_P(EveryInstructionSet, GrowthStaysSmallOnWhatNeedsPivots) {
  MatrixXd A(3, 3);
  A << 1e-20, 1.0, 0.0, 1.0, 1e-20, 1.0, 0.0, 1.0, 1.0;
  const Factor f = factorize(A, GetParam());
  EXPECT_LT(f.inverse.cwiseAbs().maxCoeff(), 10.0);
  EXPECT_LT(f.d_inverse.cwiseAbs().maxCoeff(), 10.0);
}

TEST_P(EveryInstructionSet, ReplacesPivotsThatAreZeroAndCountsThem) {
  const Factor f = factorize(MatrixXd::Ones(5, 5), GetParam());
  EXPECT_EQ(f.counts.replaced, 4);
  EXPECT_EQ(factorize(MatrixXd::Zero(9, 9), GetParam()).counts.replaced, 9);
}

INSTANTIATE_TEST_SUITE_P(Sets, EveryInstructionSet,
                         testing::Values(InstructionSet::portable, InstructionSet::avx2,
                                         InstructionSet::avx512));

TEST(BestInstructionSet, IsOneThatTheProcessorHas) { EXPECT_TRUE(has(best_instruction_set())); }

}  // namespace
}  // namespace timbre::detail
