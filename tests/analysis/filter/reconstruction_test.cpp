#include "timbre/analysis/filter/reconstruction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "timbre/analysis/filter/spectral_transform.h"
#include "timbre/tests/support/shapes.h"
#include "timbre/tests/support/synthetic_spectrum.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

// sqrt(tr F^T M F)
double norm(const SparseMatrix& mass, const MatrixXd& F) {
  return std::sqrt(F.cwiseProduct(mass * F).sum());
}

TEST(AnalyseReconstruction, SaysHowFarEachReconstructionIsFromTheFunction) {
  for (const MassKind mass : {MassKind::lumped, MassKind::consistent}) {
    const TriangleMesh mesh = make_lump(8);
    const Operator op = compute_operator(mesh, {.mass = mass});
    const Spectrum spectrum = compute_spectrum(op, {.count = 30});
    const MatrixXd F = mesh.vertices;
    const MatrixXd C = forward_transform(spectrum, op.mass, F);
    const Reconstruction found = analyse_reconstruction(spectrum, op.mass, F);
    ASSERT_EQ(found.errors.size(), 31);
    const double variation = norm(op.mass, F - inverse_transform(spectrum, C.topRows(1)));
    for (Index j = 0; j <= 30; ++j) {
      const double missed = norm(op.mass, F - inverse_transform(spectrum, C.topRows(j)));
      EXPECT_NEAR(found.errors[j], missed / variation, 1e-10);
    }
    EXPECT_EQ(found.errors[1], 1.0);
    EXPECT_NEAR(found.energies.sum() + found.detail, std::pow(norm(op.mass, F), 2), 1e-10);
  }
}

// The coordinates of the sphere are its eigenfunctions 1 to 3.
TEST(AnalyseReconstruction, FindsTheSphereInFourEigenfunctions) {
  const auto error = [](int frequency) {
    const TriangleMesh mesh = make_sphere(frequency);
    const Operator op = compute_operator(mesh);
    return analyse_reconstruction(compute_spectrum(op, {.count = 6}), op.mass, mesh.vertices)
        .errors[4];
  };
  EXPECT_LT(error(8), 1e-2);
  EXPECT_NEAR(std::log2(error(8) / error(16)), 2.0, 0.3);
}

TEST(AnalyseReconstruction, KeepsTheDigitsOfSmallErrors) {
  const Spectrum spectrum = synthetic_spectrum(Eigen::VectorXd::LinSpaced(6, 0.0, 5.0), 40);
  SparseMatrix mass(40, 40);
  mass.setIdentity();
  const MatrixXd F = spectrum.vectors.col(1) + 1e-12 * spectrum.vectors.col(4);
  const Reconstruction found = analyse_reconstruction(spectrum, mass, F);
  EXPECT_NEAR(found.errors[2] / 1e-12, 1.0, 1e-3);
  EXPECT_NEAR(found.errors[4] / 1e-12, 1.0, 1e-3);
  EXPECT_LT(found.errors[5], 1e-15);
}

TEST(AnalyseReconstruction, MissesNothingOfConstants) {
  const TriangleMesh mesh = make_lump(6);
  const Operator op = compute_operator(mesh);
  const MatrixXd F = MatrixXd::Constant(mesh.vertices.rows(), 2, 1e6);
  const Reconstruction found =
      analyse_reconstruction(compute_spectrum(op, {.count = 8}), op.mass, F);
  EXPECT_EQ(found.errors, Eigen::VectorXd::Zero(9));
}

// Errors are of the shape, not of where it lies.
TEST(AnalyseReconstruction, DoesNotSeeTheOrigin) {
  const TriangleMesh mesh = make_lump(6);
  const Operator op = compute_operator(mesh);
  const Spectrum spectrum = compute_spectrum(op, {.count = 8});
  MatrixXd moved = mesh.vertices;
  moved.rowwise() += Eigen::RowVector3d(100.0, -20.0, 3.0);
  const Eigen::VectorXd here = analyse_reconstruction(spectrum, op.mass, mesh.vertices).errors;
  const Eigen::VectorXd there = analyse_reconstruction(spectrum, op.mass, moved).errors;
  EXPECT_LT((here - there).tail(8).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_GT(there[0], 10.0);
}

}  // namespace
}  // namespace timbre
