#include "timbre/matching/alignment.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>

#include "timbre/analysis/operators/operator.h"
#include "timbre/matching/match.h"
#include "timbre/tests/support/refused_request.h"
#include "timbre/tests/support/shapes.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd random_rotation(Index size) {
  return Eigen::HouseholderQR<MatrixXd>(MatrixXd::Random(size, size)).householderQ();
}

TEST(AlignBasis, UndoesSignsOrdersAndRotationsWithinNearEqualSpaces) {
  std::srand(3);
  VectorXd values(9);
  values << 0, 1, 2, 2.02, 2.03, 4, 5, 5.01, 9;
  // C takes B's functions to A's: 1 is flipped, 2 to 4 are turned, 5 has changed places with
  // the pair behind it, which is turned.
  MatrixXd C = MatrixXd::Identity(9, 9);
  C(1, 1) = -1.0;
  C.block(2, 2, 3, 3) = random_rotation(3);
  C.block(5, 5, 3, 3).setZero();
  C(7, 5) = -1.0;
  C.block(5, 6, 2, 2) = random_rotation(2);
  const AlignedBasis basis = align_basis(C, values, {.count = 9});
  EXPECT_TRUE((C * basis.mixture).isIdentity(1e-12));
  EXPECT_TRUE((basis.mixture.transpose() * basis.mixture).isIdentity(1e-12));
  EXPECT_TRUE(basis.agreement.isOnes(1e-12));
  EXPECT_EQ(comparable_functions(basis), 9);
  EXPECT_NEAR(basis.values[7], 4.0, 1e-12);
  for (const int i : {2, 3, 4}) {
    EXPECT_GE(basis.values[i], 2.0);
    EXPECT_LE(basis.values[i], 2.03);
  }
}

TEST(AlignBasis, KeepsEigenfunctionsWholeWhereNothingMayBeMixed) {
  MatrixXd C = MatrixXd::Identity(4, 4);
  const double angle = 0.3;
  C.block(1, 1, 2, 2) << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  C.col(3) *= -1.0;
  const VectorXd values = VectorXd::LinSpaced(4, 0.0, 3.0);
  const AlignedBasis basis = align_basis(C, values, {.count = 4, .near_equal = 0.0});
  VectorXd signs(4);
  signs << 1, 1, 1, -1;
  EXPECT_TRUE(basis.mixture.isApprox(MatrixXd(signs.asDiagonal()), 1e-12));
  EXPECT_NEAR(basis.agreement[1], std::cos(angle), 1e-12);
  EXPECT_TRUE(basis.values.isApprox(values));
}

TEST(AlignBasis, SaysWhereThereIsNoCounterpart) {
  MatrixXd C = MatrixXd::Identity(5, 5);
  C(3, 3) = 0.1;
  C(4, 3) = 0.9;
  C(4, 4) = 0.0;
  C(3, 4) = 0.05;
  const AlignedBasis basis = align_basis(C, VectorXd::LinSpaced(5, 0.0, 4.0), {.count = 4});
  EXPECT_LT(basis.agreement[3], 0.7);
  EXPECT_EQ(comparable_functions(basis), 3);
}

TEST(AlignBasis, TakesSeveralConstantsForOneSpace) {
  VectorXd values(6);
  values << 0, 0, 0, 3, 3.1, 8;
  MatrixXd C = MatrixXd::Identity(6, 6);
  C.topLeftCorner(3, 3) = random_rotation(3);
  C.block(3, 3, 2, 2) = random_rotation(2);
  EXPECT_TRUE((C * align_basis(C, values, {.count = 6}).mixture).isIdentity(1e-12));
}

TEST(AlignBasis, RefusesWhatDoesNotFit) {
  const MatrixXd C = MatrixXd::Identity(3, 3);
  EXPECT_EQ(refused_request([&] { (void)align_basis(C, VectorXd::Zero(3), {.count = 4}); }),
            "count: is 4; the map has 3 x 3 entries, of 3 eigenvalues");
  EXPECT_EQ(refused_request(
                [&] { (void)align_basis(C, VectorXd::Zero(3), {.count = 3, .near_equal = -1.0}); }),
            "near_equal: must be a share, from 0 to below 1");
}

// A renumbered copy whose eigenfunctions have other signs, orders and rotations.
TEST(AlignBasis, MakesTheBasesOfCopiesEqual) {
  const SurfaceOptions small = {.eigenpairs = 80, .samples = 600, .geodesic_samples = 300};
  const TriangleMesh mesh = make_lump(12);
  const std::vector<std::int32_t> order = random_order(mesh.vertices.rows(), 5);
  const MatchSurface a = prepare_surface(mesh, small);
  SurfaceOptions larger = small;
  larger.eigenpairs = 100;
  const MatchSurface b = prepare_surface(renumbered(mesh, order), larger);
  const MatchResult found = match(a, b);  // of as many functions as the smaller spectrum has
  const MatrixXd& C = found.solutions[0].functional.ab;
  ASSERT_EQ(C.cols(), 80);
  const AlignedBasis basis = align_basis(C, b.values.head(80), {.count = 40});
  EXPECT_EQ(comparable_functions(basis, 0.999), 40);
  const MatrixXd aligned = b.vectors.leftCols(80) * basis.mixture;
  EXPECT_TRUE(aligned(order, Eigen::all).isApprox(a.vectors.leftCols(40), 1e-3));
  EXPECT_TRUE(basis.values.isApprox(a.values.head(40), 1e-6));
}

}  // namespace
}  // namespace timbre
