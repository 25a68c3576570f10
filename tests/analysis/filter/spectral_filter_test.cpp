#include "timbre/analysis/filter/spectral_filter.h"

#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <cmath>

#include "timbre/analysis/filter/spectral_transform.h"
#include "timbre/tests/support/refused_request.h"
#include "timbre/tests/support/shapes.h"
#include "timbre/tests/support/synthetic_spectrum.h"

namespace timbre {
namespace {

using Eigen::MatrixXd;

double difference(const MatrixXd& a, const MatrixXd& b) { return (a - b).cwiseAbs().maxCoeff(); }

struct Solved {
  TriangleMesh mesh;
  Operator op;
  Spectrum spectrum;
};

Solved solve(int frequency, int count, MassKind mass = MassKind::lumped) {
  Solved solved{.mesh = make_lump(frequency), .op = {}, .spectrum = {}};
  solved.op = compute_operator(solved.mesh, {.mass = mass});
  solved.spectrum = compute_spectrum(solved.op, {.count = count});
  return solved;
}

// What explicit steps of smoothing do, without a spectrum.
MatrixXd smoothed(const Operator& op, MatrixXd F, double step, int count) {
  const Eigen::SimplicialLDLT<SparseMatrix> mass(op.mass);
  for (int i = 0; i < count; ++i) F -= step * mass.solve(op.stiffness * F);
  return F;
}

TEST(ApplyFilter, IsLaplacianSmoothingIfNoEigenfunctionIsMissing) {
  for (const MassKind mass : {MassKind::lumped, MassKind::consistent}) {
    const Solved all = solve(3, 92, mass);
    const double step = 0.7 / all.spectrum.values.maxCoeff();
    EXPECT_LT(difference(apply_filter(all.spectrum, all.op.mass, all.mesh.vertices,
                                      smoothing_steps(step, 5)),
                         smoothed(all.op, all.mesh.vertices, step, 5)),
              1e-12)
        << to_word(mass);
  }
}

// Of k eigenfunctions: the same on what lies in them, and the detail times one factor.
TEST(ApplyFilter, TreatsTheDetailAsAsked) {
  const Solved some = solve(8, 20);
  const MatrixXd& phi = some.spectrum.vectors;
  const MatrixXd F = some.mesh.vertices;
  const MatrixXd low = phi * (phi.transpose() * (some.op.mass * F));
  const auto filtered = [&](const FilterOptions& options) {
    return apply_filter(
        some.spectrum, some.op.mass, F, [](double) { return 3.0; }, options);
  };
  EXPECT_LT(difference(filtered({}), 3.0 * low), 1e-12);
  EXPECT_LT(difference(filtered({.detail = 1.0}), 3.0 * low + (F - low)), 1e-12);
  EXPECT_LT(difference(filtered({.detail = -0.25}), 3.0 * low - 0.25 * (F - low)), 1e-12);
  EXPECT_EQ(filtered({.detail = 3.0}), 3.0 * F);  // nothing to tell apart: to the bit
}

TEST(ApplyFilter, HeatFlowsOnFromWhereItStopped) {
  const Solved some = solve(8, 30);
  const auto flow = [&](const MatrixXd& F, double time) {
    return apply_filter(some.spectrum, some.op.mass, F, heat(time));
  };
  const MatrixXd at_once = flow(some.mesh.vertices, 0.5);
  EXPECT_LT(difference(flow(flow(some.mesh.vertices, 0.2), 0.3), at_once), 1e-12);
  EXPECT_GT(difference(flow(some.mesh.vertices, 0.2), at_once), 0.1);
}

TEST(ApplyFilter, ABandAndWhatItStopsAreTheWhole) {
  const Solved some = solve(8, 30);
  const double low = some.spectrum.values[4];
  const double high = some.spectrum.values[9];
  const auto filter = [&](double inside, double outside) {
    return apply_filter(some.spectrum, some.op.mass, some.mesh.vertices,
                        band(low, high, inside, outside), {.detail = outside});
  };
  EXPECT_LT(difference(filter(1.0, 0.0) + filter(0.0, 1.0), some.mesh.vertices), 1e-13);
  const MatrixXd C = forward_transform(some.spectrum, some.op.mass, filter(1.0, 0.0));
  EXPECT_GT(C.middleRows(4, 6).rowwise().norm().minCoeff(), 1e-6);
  EXPECT_LT(C.topRows(4).norm() + C.bottomRows(20).norm(), 1e-10);
}

TEST(ApplyFilter, DoesNotSeeSignsAndRotationsInAnEigenspace) {
  const Eigen::VectorXd values = (Eigen::VectorXd(5) << 0, 2, 5, 5, 9).finished();
  const Spectrum spectrum = synthetic_spectrum(values, 12);
  SparseMatrix mass(12, 12);
  mass.setIdentity();
  const MatrixXd F = MatrixXd::Random(12, 3);
  const MatrixXd before = apply_filter(spectrum, mass, F, heat(0.1));
  EXPECT_LT(difference(apply_filter(turned(spectrum, 2, 0.8, 4), mass, F, heat(0.1)), before),
            1e-14);
}

TEST(ApplyFilter, LeavesVerticesWithoutPartWhereTheyAre) {
  TriangleMesh mesh = make_lump(4);
  const Eigen::Index n = mesh.vertices.rows();
  mesh.vertices.conservativeResize(n + 1, 3);
  mesh.vertices.row(n) << 7.0, 8.0, 9.0;
  const Operator op = compute_operator(mesh);
  const MatrixXd filtered =
      apply_filter(compute_spectrum(op, {.count = 5}), op.mass, mesh.vertices, heat(0.1));
  EXPECT_EQ(filtered.row(n), mesh.vertices.row(n));
  EXPECT_GT(difference(filtered.topRows(n), mesh.vertices.topRows(n)), 0.1);
}

TEST(RelativeChange, IsThatOfTheFilteredFunction) {
  const Solved some = solve(8, 20, MassKind::consistent);
  const MatrixXd F = some.mesh.vertices;
  const auto norm = [&](const MatrixXd& X) {
    return std::sqrt(X.cwiseProduct(some.op.mass * X).sum());
  };
  const Reconstruction parts = analyse_reconstruction(some.spectrum, some.op.mass, F);
  const Eigen::RowVector3d mean = (some.op.mass * F).colwise().sum() / some.op.area;
  EXPECT_NEAR(parts.variation, norm(F.rowwise() - mean), 1e-10);
  for (const double detail : {0.0, 0.3, 1.0}) {
    const MatrixXd change = apply_filter(some.spectrum, some.op.mass, F, heat(0.1), {detail}) - F;
    EXPECT_NEAR(relative_change(some.spectrum, parts, heat(0.1), {detail}),
                norm(change) / parts.variation, 1e-10);
  }
}

TEST(ApplyFilter, RefusesATransferWithoutAValue) {
  const Spectrum spectrum = synthetic_spectrum(Eigen::VectorXd::LinSpaced(3, 0.0, 2.0), 8);
  SparseMatrix mass(8, 8);
  mass.setIdentity();
  const auto inverse = [](double lambda) { return 1.0 / lambda; };
  EXPECT_EQ(
      refused_request([&] { (void)apply_filter(spectrum, mass, MatrixXd::Ones(8, 1), inverse); }),
      "transfer: is not finite at the eigenvalue 0");
}

}  // namespace
}  // namespace timbre
