#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "timbre/analysis/mesh/diagnosis.h"
#include "timbre/analysis/operators/operator.h"
#include "timbre/analysis/spectrum/spectrum.h"
#include "timbre/datasets/analytic.h"
#include "timbre/tests/support/mesh_shapes.h"
#include "timbre/tests/support/odd_shapes.h"
#include "timbre/tests/support/shapes.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd eigenvalues(const Operator& op, int count) {
  return compute_spectrum(op, {.count = count}).values;
}

// Largest relative difference of all but the zero.
double shift(const VectorXd& found, const VectorXd& expected) {
  const Index rest = expected.size() - 1;
  return ((found - expected).tail(rest).array() / expected.tail(rest).array()).abs().maxCoeff();
}

double mean_error(const VectorXd& found, const VectorXd& expected) {
  const Index rest = expected.size() - 1;
  return ((found - expected).tail(rest).array() / expected.tail(rest).array()).abs().mean();
}

double difference(const SparseMatrix& a, const SparseMatrix& b) {
  return MatrixXd(a - b).cwiseAbs().maxCoeff() / MatrixXd(b).cwiseAbs().maxCoeff();
}

double greatest_off_diagonal(const SparseMatrix& matrix) {
  MatrixXd dense = matrix;
  dense.diagonal().setConstant(-1.0);
  return dense.maxCoeff();
}

// All eigenvalues, those without part in it left out.
VectorXd dense_eigenvalues(const Operator& op) {
  std::vector<Index> used;
  for (Index v = 0; v < op.lumped_mass.size(); ++v) {
    if (op.lumped_mass[v] > 0.0) used.push_back(v);
  }
  const MatrixXd S = symmetrized(op);
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(MatrixXd(S(used, used))).eigenvalues();
}

TEST(RobustOperator, IsThatOfCotangentsOnADelaunayManifoldMesh) {
  for (const TriangleMesh& mesh : {sphere(3), torus(24, 12), grid(6), moebius_strip(40)}) {
    for (const MassKind mass : {MassKind::lumped, MassKind::consistent}) {
      const Operator robust = compute_operator(mesh, {.mass = mass});
      const Operator cotan = compute_operator(mesh, {.kind = OperatorKind::cotan, .mass = mass});
      EXPECT_EQ(robust.flips, 0);
      EXPECT_EQ(robust.mollified_by, 0.0);
      EXPECT_LT(difference(robust.stiffness, cotan.stiffness), 1e-14);
      EXPECT_LT(difference(robust.mass, cotan.mass), 1e-14);
    }
  }
}

// Sharp and Crane's promise where cotangents give negative weights or none at all.
TEST(RobustOperator, HardlyFeelsEdgesThatAreCutIntoNeedles) {
  const TriangleMesh mesh = sphere(4);
  const VectorXd uncut = eigenvalues(compute_operator(mesh), 36);
  for (const double share : {1e-2, 1e-4, 1e-8, 1e-12, 0.0}) {
    const Operator op = compute_operator(with_cut_edges(mesh, 200, share));
    EXPECT_LE(greatest_off_diagonal(op.stiffness), 0.0) << share;
    EXPECT_LE(shift(eigenvalues(op, 36), uncut), 3e-5) << share;
    EXPECT_EQ(op.mollified_by > 0.0, share < 1e-6) << share;
  }
}

TEST(RobustOperator, FindsTheSpectrumOfAFlatMoebiusStrip) {
  const IntrinsicMesh strip = make_flat_moebius_strip(60, 20);
  const Operator op = compute_operator(strip.faces, strip.lengths, strip.vertices);
  EXPECT_LE(mean_error(eigenvalues(op, 36), moebius_spectrum(36)), 1.1e-2);
  EXPECT_NEAR(op.area, 3.0, 1e-12);
}

TEST(RobustOperator, FindsTheSpectrumOfBooksWhateverWayTheirFacesAreTurned) {
  for (const int pages : {2, 3, 5}) {
    const TriangleMesh book = make_book(pages, 24);
    const Operator op = compute_operator(with_faces_shuffled(book, 5));
    const Operator cotan = compute_operator(book, {.kind = OperatorKind::cotan});
    EXPECT_LT(difference(op.stiffness, cotan.stiffness), 1e-14) << pages;
    // Four times the prototype's figures on twice the rows.
    EXPECT_LE(mean_error(eigenvalues(op, 36), book_spectrum(pages, 36)), 2.2e-2) << pages;
  }
}

TEST(RobustOperator, FlipsWhatIsNotDelaunayInABook) {
  const TriangleMesh book = make_book(5, 24, true);
  const Operator cotan = compute_operator(book, {.kind = OperatorKind::cotan});
  const Operator robust = compute_operator(book);
  EXPECT_GT(greatest_off_diagonal(cotan.stiffness), 0.01);
  EXPECT_LE(greatest_off_diagonal(robust.stiffness), 0.0);
  EXPECT_GT(robust.flips, 0);
  EXPECT_NEAR(robust.area, 10.0, 1e-12);
  const VectorXd exact = book_spectrum(5, 36);
  EXPECT_LE(mean_error(eigenvalues(robust, 36), exact), 1e-2);
}

TEST(RobustOperator, CountsFacesStoredTwiceTwice) {
  const TriangleMesh once = sphere(3);  // acute: no flip mixes the two
  const Operator single = compute_operator(once);
  const Index m = once.faces.rows();
  for (const bool turned : {false, true}) {
    TriangleMesh twice = once;
    twice.faces.conservativeResize(2 * m, 3);
    twice.faces.bottomRows(m) = once.faces;
    if (turned) twice.faces.bottomRows(m).col(1).swap(twice.faces.bottomRows(m).col(2));
    const Operator op = compute_operator(twice);
    EXPECT_LT(difference(op.stiffness, 2.0 * single.stiffness), 1e-13) << turned;
    EXPECT_LT(difference(op.mass, 2.0 * single.mass), 1e-13) << turned;
  }
}

TEST(RobustOperator, IsZeroThreeThreeOnOneTriangle) {
  const Operator op = compute_operator(make_mesh({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}}));
  const VectorXd values = eigenvalues(op, 3);
  EXPECT_EQ(values[0], 0.0);
  EXPECT_NEAR(values[1], 3.0, 1e-14);
  EXPECT_NEAR(values[2], 3.0, 1e-14);
}

TEST(RobustOperator, KeepsAFaceOfThreeEqualPointsBesideOneWithArea) {
  const Operator op = compute_operator(
      make_mesh({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 3, 4}}));
  EXPECT_GT(op.mollified_by, 0.0);
  EXPECT_NEAR(op.area, 0.500006, 1e-6);  // the prototype's
  EXPECT_GT(op.lumped_mass.minCoeff(), 0.0);
  EXPECT_LE(greatest_off_diagonal(op.stiffness), 0.0);
}

class EverySoup : public testing::TestWithParam<SoupKind> {};

INSTANTIATE_TEST_SUITE_P(Kinds, EverySoup,
                         testing::Values(SoupKind::generic, SoupKind::lattice, SoupKind::flat,
                                         SoupKind::line, SoupKind::spread, SoupKind::rounded));

TEST_P(EverySoup, HasWeightsThatAreNotNegativeAndAPositiveOperator) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const TriangleMesh soup = make_soup(GetParam(), seed);
    if (diagnose(soup).area < 1e-12) continue;  // points of the lattice on one line
    const Operator op = compute_operator(soup);
    const MatrixXd W = op.stiffness;
    ASSERT_TRUE(W.allFinite()) << seed;
    EXPECT_TRUE(W == W.transpose()) << seed;
    EXPECT_LE(greatest_off_diagonal(op.stiffness), 0.0) << seed;
    const VectorXd values = Eigen::SelfAdjointEigenSolver<MatrixXd>(W).eigenvalues();
    EXPECT_GT(values[0], -1e-12 * values.maxCoeff()) << seed;
  }
}

// Where faces meet at points that coincide, nothing but numbers orders them about an edge: the
// lattice is left out.
class EverySoupWithoutTies : public testing::TestWithParam<SoupKind> {};

INSTANTIATE_TEST_SUITE_P(Kinds, EverySoupWithoutTies,
                         testing::Values(SoupKind::generic, SoupKind::flat, SoupKind::line,
                                         SoupKind::spread, SoupKind::rounded));

TEST_P(EverySoupWithoutTies, DoesNotHangOnNumberingOrScale) {
  for (unsigned seed = 0; seed < 25; ++seed) {
    const TriangleMesh soup = make_soup(GetParam(), seed);
    const VectorXd values = dense_eigenvalues(compute_operator(soup));
    const TriangleMesh other =
        with_faces_shuffled(renumbered(soup, random_order(soup.vertices.rows(), seed)), seed);
    const VectorXd again = dense_eigenvalues(compute_operator(other));
    ASSERT_EQ(again.size(), values.size()) << seed;
    EXPECT_LT((again - values).cwiseAbs().maxCoeff(), 1e-8 * values.maxCoeff()) << seed;
    TriangleMesh doubled = soup;
    doubled.vertices *= 0x1p40;
    EXPECT_EQ(MatrixXd(compute_operator(doubled).stiffness),
              MatrixXd(compute_operator(soup).stiffness))
        << seed;
  }
}

TEST(RobustOperator, LeavesASeamOfCoincidentVerticesOpen) {
  TriangleMesh rolled = make_rectangle(2.0 * std::numbers::pi, 2.0, 48, 16);
  for (auto row : rolled.vertices.rowwise()) {
    row = Eigen::RowVector3d(std::cos(row[0]), std::sin(row[0]), row[1]);
  }
  const VectorXd open = eigenvalues(compute_operator(rolled), 3);
  const VectorXd closed = eigenvalues(compute_operator(make_cylinder(2.0, 48, 17)), 3);
  // Half a wave fits around the open one; only a whole one around the closed, twice.
  EXPECT_NEAR(open[1], 0.25, 0.01);
  EXPECT_NEAR(open[2], 1.0, 0.01);
  EXPECT_NEAR(closed[1], 1.0, 0.01);
  EXPECT_NEAR(closed[2], 1.0, 0.01);
}

}  // namespace
}  // namespace timbre
