#include "timbre/analysis/filter/fiedler_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "timbre/analysis/spectrum/spectrum.h"
#include "timbre/datasets/analytic.h"
#include "timbre/tests/support/refused_request.h"
#include "timbre/tests/support/shapes.h"

namespace timbre {
namespace {

using std::numbers::pi;

constexpr double kFirst = pi * pi / 16.0;  // lambda_1 of the strip

// [0, 4] x [0, 1], 17 x 5 vertices, row by row.
TriangleMesh strip() { return make_rectangle(4.0, 1.0, 16, 4); }

// Both in one list, the second scaled.
TriangleMesh beside(const TriangleMesh& a, const TriangleMesh& b, double scale) {
  TriangleMesh both = a;
  both.vertices.conservativeResize(a.vertices.rows() + b.vertices.rows(), 3);
  both.vertices.bottomRows(b.vertices.rows()) = scale * b.vertices;
  both.faces.conservativeResize(a.faces.rows() + b.faces.rows(), 3);
  both.faces.bottomRows(b.faces.rows()) =
      b.faces.array() + static_cast<std::int32_t>(a.vertices.rows());
  return both;
}

void expect_permutation(std::vector<std::int32_t> order, Eigen::Index n) {
  ASSERT_EQ(std::ssize(order), n);
  std::sort(order.begin(), order.end());
  for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], static_cast<int>(i));
}

// From one end to the other, whatever the order within a column of vertices.
void expect_along_x(const TriangleMesh& mesh, const std::vector<std::int32_t>& order) {
  for (std::size_t i = 1; i < order.size(); ++i) {
    EXPECT_GE(mesh.vertices(order[i], 0), mesh.vertices(order[i - 1], 0) - 1e-12) << i;
  }
}

TEST(FiedlerOrder, RunsAlongAStrip) {
  const TriangleMesh mesh = strip();
  for (const OperatorKind kind : {OperatorKind::robust, OperatorKind::dec, OperatorKind::p2}) {
    const FiedlerOrder found = compute_fiedler_order(compute_operator(mesh, {.kind = kind}));
    expect_permutation(found.order, mesh.vertices.rows());
    expect_along_x(mesh, found.order);
  }
}

TEST(FiedlerOrder, KnowsTheClosedFormOfAStrip) {
  const TriangleMesh mesh = strip();
  const FiedlerOrder found = compute_fiedler_order(compute_operator(mesh));
  ASSERT_EQ(found.values.size(), 1);
  EXPECT_NEAR(found.values[0], kFirst, 0.01 * kFirst);
  EXPECT_NEAR(found.gaps[0], 0.75, 0.01);                    // from (pi / 4)^2 to (2 pi / 4)^2
  for (Eigen::Index v = 0; v < mesh.vertices.rows(); ++v) {  // norm 1 on area 4
    EXPECT_NEAR(found.vector[v], -std::cos(0.25 * pi * mesh.vertices(v, 0)) / std::sqrt(2.0), 5e-3);
  }
}

TEST(FiedlerOrder, IsTheSecondEigenfunctionOfAConnectedSurface) {
  const Operator op = compute_operator(make_lump(8));
  const FiedlerOrder found = compute_fiedler_order(op);
  const Eigen::VectorXd second = compute_spectrum(op, {.count = 5}).vectors.col(1);
  EXPECT_NEAR(std::abs(found.vector.dot(op.mass * second)), 1.0, 1e-10);
  for (std::size_t i = 1; i < found.order.size(); ++i) {
    EXPECT_LE(found.vector[found.order[i - 1]], found.vector[found.order[i]]);
  }
}

// Whatever sign the solver gave.
TEST(FiedlerOrder, StartsAtTheEndWithTheSmallerNumber) {
  const TriangleMesh mesh = make_lump(5);
  for (const unsigned seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
    const FiedlerOrder found = compute_fiedler_order(
        compute_operator(renumbered(mesh, random_order(mesh.vertices.rows(), seed))));
    EXPECT_LT(found.order.front(), found.order.back()) << seed;
  }
}

// lambda_1 of the small strip is 10^6 times that of the large one.
TEST(FiedlerOrder, GivesEachComponentItsOwnHoweverSmall) {
  const TriangleMesh mesh = beside(strip(), strip(), 1e-3);
  const FiedlerOrder found = compute_fiedler_order(compute_operator(mesh));
  const auto half = static_cast<std::ptrdiff_t>(strip().vertices.rows());
  expect_permutation(found.order, 2 * half);
  EXPECT_LT(*std::max_element(found.order.begin(), found.order.begin() + half), half);
  expect_along_x(mesh, {found.order.begin(), found.order.begin() + half});
  expect_along_x(mesh, {found.order.begin() + half, found.order.end()});
  ASSERT_EQ(found.values.size(), 2);
  EXPECT_NEAR(found.values[1] / found.values[0], 1e6, 1.0);
}

TEST(FiedlerOrder, PutsVerticesWithoutPartLast) {
  TriangleMesh mesh = strip();
  for (std::int32_t& corner : mesh.faces.reshaped()) ++corner;
  Points shifted(mesh.vertices.rows() + 1, 3);
  shifted << Eigen::RowVector3d(-9.0, 0.0, 0.0), mesh.vertices;
  mesh.vertices = shifted;
  const FiedlerOrder found = compute_fiedler_order(compute_operator(mesh));
  expect_permutation(found.order, mesh.vertices.rows());
  EXPECT_EQ(found.order.back(), 0);
  EXPECT_EQ(found.vector[0], 0.0);
}

TEST(FiedlerOrder, ShowsWhereItIsOneOfMany) {
  EXPECT_LT(compute_fiedler_order(compute_operator(make_sphere(8))).gaps[0], 1e-6);
}

TEST(FiedlerOrder, RefusesADirichletBoundary) {
  const Operator op = compute_operator(strip(), {.boundary = BoundaryKind::dirichlet});
  EXPECT_EQ(refused_request([&] { (void)compute_fiedler_order(op); }),
            "boundary: the Fiedler vector is one of the neumann boundary");
}

}  // namespace
}  // namespace timbre
