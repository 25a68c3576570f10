#include "timbre/analysis/filter/spectral_transform.h"

#include <gtest/gtest.h>

#include "timbre/tests/support/refused_request.h"
#include "timbre/tests/support/shapes.h"
#include "timbre/tests/support/synthetic_spectrum.h"

namespace timbre {
namespace {

using Eigen::MatrixXd;

class TransformInEitherMass : public testing::TestWithParam<MassKind> {};
INSTANTIATE_TEST_SUITE_P(Masses, TransformInEitherMass,
                         testing::Values(MassKind::lumped, MassKind::consistent));

TEST_P(TransformInEitherMass, ThereAndBackIsTheFunctionIfNoEigenfunctionIsMissing) {
  const TriangleMesh mesh = make_lump(3);
  const Operator op = compute_operator(mesh, {.mass = GetParam()});
  const Spectrum all = compute_spectrum(op, {.count = 92});
  ASSERT_EQ(all.values.size(), mesh.vertices.rows());
  const MatrixXd back = inverse_transform(all, forward_transform(all, op.mass, mesh.vertices));
  EXPECT_LT((back - mesh.vertices).cwiseAbs().maxCoeff(), 1e-12);
}

TEST_P(TransformInEitherMass, FindsTheCoefficientsThatAFunctionWasMadeOf) {
  const Operator op = compute_operator(make_lump(8), {.mass = GetParam()});
  const Spectrum some = compute_spectrum(op, {.count = 20});
  const MatrixXd made_of = MatrixXd::Random(20, 2);
  const MatrixXd found = forward_transform(some, op.mass, inverse_transform(some, made_of));
  EXPECT_LT((found - made_of).cwiseAbs().maxCoeff(), 1e-10);
}

TEST_P(TransformInEitherMass, KeepsInnerProducts) {  // Parseval
  const TriangleMesh mesh = make_lump(3);
  const Operator op = compute_operator(mesh, {.mass = GetParam()});
  const Spectrum all = compute_spectrum(op, {.count = 92});
  const MatrixXd C = forward_transform(all, op.mass, mesh.vertices);
  const MatrixXd products = mesh.vertices.transpose() * (op.mass * mesh.vertices);
  EXPECT_LT((C.transpose() * C - products).cwiseAbs().maxCoeff(), 1e-12 * products.norm());
}

TEST(InverseTransform, TakesFewerCoefficientsAsTheLowest) {
  const Spectrum spectrum = synthetic_spectrum(Eigen::VectorXd::LinSpaced(6, 0.0, 5.0), 12);
  MatrixXd padded = MatrixXd::Zero(6, 3);
  padded.topRows(2).setRandom();
  EXPECT_LT((inverse_transform(spectrum, padded.topRows(2)) - inverse_transform(spectrum, padded))
                .cwiseAbs()
                .maxCoeff(),
            1e-15);
}

TEST(SpectralTransform, RefusesSizesThatDoNotAgree) {
  const Spectrum spectrum = synthetic_spectrum(Eigen::VectorXd::LinSpaced(3, 0.0, 2.0), 8);
  SparseMatrix mass(8, 8);
  mass.setIdentity();
  EXPECT_EQ(refused_request([&] { (void)forward_transform(spectrum, mass, MatrixXd::Ones(7, 1)); }),
            "transform: the functions have 7 rows and the mass 8; the eigenfunctions have 8");
  mass.resize(9, 9);
  EXPECT_EQ(refused_request([&] { (void)forward_transform(spectrum, mass, MatrixXd::Ones(8, 1)); }),
            "transform: the functions have 8 rows and the mass 9; the eigenfunctions have 8");
  EXPECT_EQ(refused_request([&] { (void)inverse_transform(spectrum, MatrixXd::Ones(4, 1)); }),
            "transform: 4 coefficients are too many for 3 eigenfunctions");
}

}  // namespace
}  // namespace timbre
