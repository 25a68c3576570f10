#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "timbre/analysis/operators/operator.h"
#include "timbre/analysis/spectrum/spectrum.h"
#include "timbre/datasets/analytic.h"
#include "timbre/tests/support/mesh_shapes.h"
#include "timbre/tests/support/shapes.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kPi = std::numbers::pi;

VectorXd eigenvalues(const TriangleMesh& mesh, OperatorKind kind, int count = 20) {
  return compute_spectrum(compute_operator(mesh, {.kind = kind}), {.count = count}).values;
}

TEST(GraphLaplacian, CountsNeighbours) {
  const Operator op = compute_operator(tetrahedron(), {.kind = OperatorKind::graph});
  EXPECT_EQ(MatrixXd(op.stiffness), 4.0 * MatrixXd::Identity(4, 4) - MatrixXd::Ones(4, 4));
  EXPECT_EQ(MatrixXd(op.mass), MatrixXd::Identity(4, 4));
  EXPECT_EQ(op.area, 4.0);
}

// On a torus of n x n vertices, each with six neighbours, in closed form.
TEST(GraphLaplacian, HasTheClosedFormOfATriangulatedTorus) {
  const int n = 9;
  std::vector<double> exact;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double a = 2.0 * kPi * i / n;
      const double b = 2.0 * kPi * j / n;
      exact.push_back(6.0 - 2.0 * (std::cos(a) + std::cos(b) + std::cos(a + b)));
    }
  }
  std::sort(exact.begin(), exact.end());
  const VectorXd graph = eigenvalues(torus(n, n), OperatorKind::graph, n * n);
  const VectorXd tutte = eigenvalues(torus(n, n), OperatorKind::tutte, n * n);
  for (Index i = 0; i < n * n; ++i) {
    EXPECT_NEAR(graph[i], exact[static_cast<std::size_t>(i)], 1e-12);
    EXPECT_NEAR(tutte[i], exact[static_cast<std::size_t>(i)] / 6.0, 1e-12);
  }
}

TEST(TutteLaplacian, HasEigenvaluesFromZeroToTwoWithDegreesForMass) {
  const TriangleMesh mesh = make_rectangle(1.0, 1.0, 4, 3);
  const Operator op = compute_operator(mesh, {.kind = OperatorKind::tutte});
  EXPECT_EQ(op.mass_kind, MassKind::degree);
  EXPECT_EQ(VectorXd(op.mass.diagonal()), VectorXd(op.stiffness.diagonal()));
  const VectorXd values = eigenvalues(mesh, OperatorKind::tutte, 20);
  EXPECT_EQ(values[0], 0.0);
  EXPECT_LE(values.maxCoeff(), 2.0);
}

TEST(DecLaplacian, DiffersFromCotangentsInTheMassOnly) {
  const TriangleMesh mesh = make_ellipsoid(1.0, 0.7, 2.0, 6);
  const Operator dec = compute_operator(mesh, {.kind = OperatorKind::dec});
  const Operator cotan = compute_operator(mesh, {.kind = OperatorKind::cotan});
  EXPECT_EQ(MatrixXd(dec.stiffness), MatrixXd(cotan.stiffness));
  EXPECT_NEAR(dec.area, cotan.area, 1e-13);
  EXPECT_GT((dec.lumped_mass - cotan.lumped_mass).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(DecLaplacian, IsThatOfCotangentsWhereAllAnglesAreSixtyDegrees) {
  const Operator dec = compute_operator(octahedron(), {.kind = OperatorKind::dec});
  const Operator cotan = compute_operator(octahedron(), {.kind = OperatorKind::cotan});
  EXPECT_LT((dec.lumped_mass - cotan.lumped_mass).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(DecLaplacian, GivesObtuseTrianglesNoNegativeCell) {
  const Operator op = compute_operator(make_mesh({{0, 0, 0}, {10, 0, 0}, {5, 1, 0}}, {{0, 1, 2}}),
                                       {.kind = OperatorKind::dec});
  EXPECT_NEAR(op.lumped_mass[2], 2.5, 1e-14);
  EXPECT_NEAR(op.lumped_mass[0], 1.25, 1e-14);
  EXPECT_NEAR(op.lumped_mass[1], 1.25, 1e-14);
}

TEST(DecLaplacian, CutsATriangleAtItsCircumcentre) {
  // Right angle: the circumcentre is the middle of the longest side.
  const Operator op = compute_operator(make_mesh({{0, 0, 0}, {4, 0, 0}, {0, 2, 0}}, {{0, 1, 2}}),
                                       {.kind = OperatorKind::dec});
  EXPECT_NEAR(op.lumped_mass[0], 2.0, 1e-14);
  EXPECT_NEAR(op.lumped_mass[1], 1.0, 1e-14);
  EXPECT_NEAR(op.lumped_mass[2], 1.0, 1e-14);
}

// Figure 18: only operators that know the areas are blind to how densely a surface is sampled.
TEST(Figure18, OperatorsThatKnowAreasAreBlindToTheSampling) {
  const TriangleMesh even = make_rectangle(1.0, 2.0, 16, 32);
  TriangleMesh uneven = even;  // denser towards x = 0
  uneven.vertices.col(0) =
      even.vertices.col(0).array().square() * 0.7 + 0.3 * even.vertices.col(0).array();
  const auto change = [&](OperatorKind kind) {
    const VectorXd a = eigenvalues(even, kind, 4);
    const VectorXd b = eigenvalues(uneven, kind, 4);
    return ((a - b).tail(3).array() / a.tail(3).array()).abs().maxCoeff();
  };
  for (const OperatorKind kind : {OperatorKind::robust, OperatorKind::cotan, OperatorKind::dec,
                                  OperatorKind::p2, OperatorKind::p3}) {
    EXPECT_LT(change(kind), 0.03) << to_word(kind);
  }
  for (const OperatorKind kind : {OperatorKind::unweighted, OperatorKind::averaged}) {
    EXPECT_GT(change(kind), 0.03) << to_word(kind);
  }
  // These do not see that anything moved.
  EXPECT_LT(change(OperatorKind::graph), 1e-12);
  EXPECT_LT(change(OperatorKind::tutte), 1e-12);
}

TEST(UnweightedLaplacian, IsThatOfCotangentsWhereAllVerticesAreAlike) {
  const VectorXd cotan = eigenvalues(octahedron(), OperatorKind::cotan, 6);
  for (const OperatorKind kind : {OperatorKind::unweighted, OperatorKind::averaged}) {
    EXPECT_LT((eigenvalues(octahedron(), kind, 6) - cotan).cwiseAbs().maxCoeff(), 1e-13);
  }
}

}  // namespace
}  // namespace timbre
