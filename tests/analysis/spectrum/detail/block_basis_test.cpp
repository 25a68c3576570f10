#include "timbre/analysis/spectrum/detail/block_basis.h"

#include <gtest/gtest.h>

#include <Eigen/SparseCore>
#include <algorithm>
#include <tuple>
#include <vector>

#include "timbre/analysis/spectrum/detail/pencil.h"

namespace timbre::detail {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// A mass with a diagonal, or with neighbours in it; both positive definite.
Eigen::SparseMatrix<double> mass_matrix(int size, bool is_diagonal) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < size; ++i) {
    entries.emplace_back(i, i, 1.0 + 0.5 * (i % 7));
    if (is_diagonal || i + 3 >= size) continue;
    entries.emplace_back(i, i + 3, 0.3);
    entries.emplace_back(i + 3, i, 0.3);
  }
  Eigen::SparseMatrix<double> M(size, size);
  M.setFromTriplets(entries.begin(), entries.end());
  return M;
}

struct Masses {
  Masses(int size, bool is_diagonal, int threads = 1)
      : M(mass_matrix(size, is_diagonal)), pencil(make_pencil(M, M)), mass(pencil, threads) {}

  Eigen::SparseMatrix<double> M;
  Pencil pencil;
  BlockMass mass;
};

Square random_rows(Index rows, Index width, unsigned seed) {
  std::srand(seed);
  return Square::Random(rows, width);
}

void append(BlockBasis& basis, const Square& block) {
  std::copy_n(block.data(), block.size(), basis.next());
  basis.append_next();
}

using Case = std::tuple<InstructionSet, int, bool>;  // width, is_diagonal

class EveryBasis : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    if (!has(std::get<0>(GetParam()))) GTEST_SKIP() << "not on this processor";
  }
};

// Sizes that end inside a chunk, of one piece and of several.
TEST_P(EveryBasis, ProductsAreThoseOfDenseMatrices) {
  const auto [set, width, is_diagonal] = GetParam();
  for (const int size : {37, 1031, 8261}) {
    SCOPED_TRACE(size);
    const Masses masses(size, is_diagonal);
    const auto& [M, pencil, mass] = masses;
    EXPECT_EQ(mass.is_diagonal(), is_diagonal);
    BlockBasis basis(mass, width, set, 1);
    MatrixXd V(size, Index{4} * width);
    for (int j = 0; j < 4; ++j) {
      const Square block = random_rows(size, width, static_cast<unsigned>(j));
      append(basis, block);
      V.middleCols(Index{j} * width, width) = block;
    }
    ASSERT_EQ(basis.blocks(), 4);
    const double tolerance = 1e-13 * size;
    const Square start = random_rows(size, width, 9);
    const MatrixXd last = V.rightCols(width);
    const MatrixXd last_but_one = V.middleCols(Index{2} * width, width);
    const Square C = random_rows(width, width, 10);

    Square U = start;
    const Square Z = random_rows(size, width, 11);
    const Square A = basis.subtract_last_but_one(C, Z.data(), U.data());
    const MatrixXd less = start - last_but_one * C;
    EXPECT_TRUE(U.isApprox(less, tolerance));
    EXPECT_TRUE(A.isApprox(Z.transpose() * less, tolerance));

    for (const int first : {0, 2}) {
      const MatrixXd tail = V.rightCols(Index{4 - first} * width);
      U = start;
      Square H = basis.subtract_last(C, U.data(), first);
      EXPECT_TRUE(U.isApprox(start - last * C, tolerance));
      EXPECT_TRUE(H.isApprox(tail.transpose() * (M * U), tolerance));
      EXPECT_TRUE(basis.products(U.data(), first).isApprox(H, tolerance));
      const MatrixXd expected = U - tail * H;
      const Square G = basis.subtract(H, U.data(), first);
      EXPECT_TRUE(U.isApprox(expected, tolerance));
      EXPECT_TRUE(G.isApprox(expected.transpose() * (M * expected), tolerance));
    }
  }
}

TEST_P(EveryBasis, OrthonormalizesInTheInnerProductOfTheMass) {
  const auto [set, width, is_diagonal] = GetParam();
  const Masses masses(531, is_diagonal);
  const auto& [M, pencil, mass] = masses;
  const BlockBasis basis(mass, width, set, 1);
  const Square start = random_rows(pencil.size, width, 3);
  Square U = start;
  Square Z(pencil.size, width);
  const Square gram = start.transpose() * (M * start);
  const BlockFactor factor = basis.orthonormalize(gram, VectorXd::Zero(width), U.data(), Z.data());
  EXPECT_TRUE(factor.R.isUpperTriangular(0.0));
  EXPECT_GT(factor.smallest_pivot, 0.5);
  EXPECT_TRUE(start.isApprox(U * factor.R, 1e-13));
  EXPECT_TRUE(Z.isApprox(M * U, 1e-13));
  EXPECT_TRUE((U.transpose() * Z).isIdentity(1e-12));
}

TEST_P(EveryBasis, AnswersDoNotDependOnThreads) {
  const auto [set, width, is_diagonal] = GetParam();
  static constexpr int kSize = 20011;
  const auto run = [width = width, set = set, is_diagonal = is_diagonal](int threads) {
    const Masses masses(kSize, is_diagonal, threads);
    BlockBasis basis(masses.mass, width, set, threads);
    for (unsigned j = 0; j < 3; ++j) append(basis, random_rows(kSize, width, j));
    Square U = random_rows(kSize, width, 5);
    Square Z(kSize, width);
    const Square C = 0.1 * random_rows(width, width, 6);
    const Square H = basis.subtract_last(C, U.data(), 0);
    const Square gram = basis.subtract(1e-5 * H, U.data(), 0);
    (void)basis.orthonormalize(gram, VectorXd::Zero(width), U.data(), Z.data());
    return Z;
  };
  const Square one = run(1);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(run(threads), one) << threads;
}

INSTANTIATE_TEST_SUITE_P(Cases, EveryBasis,
                         testing::Combine(testing::Values(InstructionSet::portable,
                                                          InstructionSet::avx2,
                                                          InstructionSet::avx512),
                                          testing::Values(8, 16), testing::Bool()));

TEST(GramFactor, TellsWhatIsNearlyDependent) {
  Square U = random_rows(100, 8, 1);
  EXPECT_GT(factorize_gram(U.transpose() * U, VectorXd::Zero(8)).smallest_pivot, 0.1);
  U.col(5) = U.col(2) + 1e-5 * U.col(5);
  const BlockFactor factor = factorize_gram(U.transpose() * U, VectorXd::Zero(8));
  EXPECT_LT(factor.smallest_pivot, 1e-9);
  EXPECT_GT(factor.smallest_pivot, 1e-11);
}

// The small rest of a column survives, whatever the rounding of the Gram matrix.
TEST_P(EveryBasis, OrthonormalizesNearlyDependentColumnsInSeveralPasses) {
  const auto [set, width, is_diagonal] = GetParam();
  const Masses masses(300, is_diagonal);
  const auto& [M, pencil, mass] = masses;
  const BlockBasis basis(mass, width, set, 1);
  Square start = random_rows(pencil.size, width, 3);
  const MatrixXd rest = random_rows(pencil.size, 1, 4);
  start.col(5) = start.col(2) - 3.0 * start.col(4) + 1e-10 * rest;
  Square U = start;
  Square Z(pencil.size, width);
  Square R = Square::Identity(width, width);
  for (int pass = 0; pass < 3; ++pass) {
    R = basis.orthonormalize(U.transpose() * (M * U), VectorXd::Zero(width), U.data(), Z.data()).R *
        R;
  }
  EXPECT_TRUE((U.transpose() * Z).isIdentity(1e-12));
  EXPECT_TRUE((U * R).isApprox(start, 1e-14));
  MatrixXd others = start;
  others.col(5) = rest;
  const MatrixXd gram = others.transpose() * (M * others);
  // The last diagonal entry of a Cholesky factor is the distance to all the others.
  MatrixXd before = gram.topLeftCorner(6, 6);
  const double distance = MatrixXd(before.llt().matrixU())(5, 5);
  EXPECT_NEAR(R(5, 5), 1e-10 * distance, 1e-14);
}

// A column of 0, and one whose rest beside the others is below what counts.
TEST_P(EveryBasis, LeavesOutColumnsOfNothing) {
  const auto [set, width, is_diagonal] = GetParam();
  const Masses masses(300, is_diagonal);
  const auto& [M, pencil, mass] = masses;
  const BlockBasis basis(mass, width, set, 1);
  Square U = random_rows(pencil.size, width, 3);
  U.col(3).setZero();
  U.col(5) = U.col(2) + 1e-4 * random_rows(pencil.size, 1, 4);
  const Square start = U;
  Square Z(pencil.size, width);
  const BlockFactor factor = basis.orthonormalize(
      U.transpose() * (M * U), VectorXd::Constant(width, 0.1), U.data(), Z.data());
  EXPECT_EQ(factor.smallest_pivot, 0.0);
  Square expected = Square::Identity(width, width);
  for (const int c : {3, 5}) {
    EXPECT_TRUE(factor.R.row(c).isZero(0.0)) << c;
    EXPECT_TRUE(U.col(c).isZero(0.0)) << c;
    expected(c, c) = 0.0;
  }
  EXPECT_TRUE((U.transpose() * Z).isApprox(expected, 1e-12));
  EXPECT_TRUE((U * factor.R).isApprox(start, 1e-4));
}

}  // namespace
}  // namespace timbre::detail
