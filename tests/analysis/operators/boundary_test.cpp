#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/operators/operator.h"
#include "timbre/analysis/spectrum/spectrum.h"
#include "timbre/datasets/analytic.h"
#include "timbre/tests/support/mesh_shapes.h"
#include "timbre/tests/support/odd_shapes.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kPi = std::numbers::pi;
constexpr OperatorOptions kFixed = {.boundary = BoundaryKind::dirichlet};

TEST(DirichletBoundary, GivesTheZerosOfBesselFunctionsOnTheDisk) {
  const VectorXd values =
      compute_spectrum(compute_operator(make_disk(40), kFixed), {.count = 6}).values;
  const double exact[] = {5.7831860, 14.6819706, 14.6819706, 26.3746164, 26.3746164, 30.4712623};
  for (Index i = 0; i < 6; ++i) EXPECT_NEAR(values[i] / exact[i], 1.0, 5e-3) << i;
}

TEST(DirichletBoundary, GivesTheClosedFormOnTheCylinder) {
  const double height = 3.0;
  const VectorXd values =
      compute_spectrum(compute_operator(make_cylinder(height, 60, 30), kFixed), {.count = 3})
          .values;
  const double first = std::pow(kPi / height, 2);
  EXPECT_NEAR(values[0] / first, 1.0, 5e-3);
  EXPECT_NEAR(values[1] / (1.0 + first), 1.0, 5e-3);
  EXPECT_NEAR(values[2] / (1.0 + first), 1.0, 5e-3);
}

TEST(DirichletBoundary, FixesFunctionsThereAndKeepsTheArea) {
  const TriangleMesh mesh = grid(6);
  const Operator op = compute_operator(mesh, kFixed);
  const Spectrum found = compute_spectrum(op, {.count = 5});
  EXPECT_EQ(found.zeros, 0);
  EXPECT_GT(found.values[0], 0.0);
  EXPECT_NEAR(op.area, 1.0, 1e-14);
  EXPECT_LT(op.component_area.sum(), 1.0);
  for (Index v = 0; v < mesh.vertices.rows(); ++v) {
    const auto p = mesh.vertices.row(v);
    const bool rim = p[0] == 0.0 || p[0] == 1.0 || p[1] == 0.0 || p[1] == 1.0;
    EXPECT_EQ(op.component[static_cast<std::size_t>(v)] < 0, rim);
    if (rim) {
      EXPECT_EQ(found.vectors.row(v).norm(), 0.0);
    }
  }
}

TEST(DirichletBoundary, LeavesClosedSurfacesAsTheyAre) {
  const TriangleMesh mesh = sphere(2);
  const Operator fixed = compute_operator(mesh, kFixed);
  const Operator natural = compute_operator(mesh);
  EXPECT_EQ(Eigen::MatrixXd(fixed.stiffness), Eigen::MatrixXd(natural.stiffness));
  EXPECT_EQ(count_zeros(fixed), 1);
  EXPECT_EQ(compute_spectrum(fixed, {.count = 3}).zeros, 1);
}

TEST(DirichletBoundary, HoldsOnEdgesOfOneFaceOnlyWherePagesMeet) {
  // Functions are 0 around each page; at the spine, of three faces, they are free.
  const Operator op = compute_operator(make_book(3, 32), kFixed);
  const VectorXd values = compute_spectrum(op, {.count = 4}).values;
  const auto with = [](double across) {
    return std::pow(across * kPi, 2) + std::pow(kPi / 2.0, 2);
  };
  EXPECT_NEAR(values[0] / with(0.5), 1.0, 1e-2);  // the same on all pages
  EXPECT_NEAR(values[1] / with(1.0), 1.0, 2e-2);  // 0 at the spine, twice
  EXPECT_NEAR(values[2] / with(1.0), 1.0, 2e-2);
}

TEST(DirichletBoundary, MayPartAComponent) {
  // Two squares of four triangles around a centre, joined at one corner.
  const TriangleMesh mesh = make_mesh(
      {{0, 0, 0},
       {2, 0, 0},
       {2, 2, 0},
       {0, 2, 0},
       {1, 1, 0},
       {4, 2, 0},
       {4, 4, 0},
       {2, 4, 0},
       {3, 3, 0}},
      {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {2, 5, 8}, {5, 6, 8}, {6, 7, 8}, {7, 2, 8}});
  const Operator op = compute_operator(mesh, kFixed);
  EXPECT_EQ(op.component_area.size(), 2);
  const VectorXd values = compute_spectrum(op, {.count = 10}).values;
  ASSERT_EQ(values.size(), 2);  // as many as vertices within
  EXPECT_NEAR(values[0], 4.0 / (4.0 / 3.0), 1e-14);
  EXPECT_NEAR(values[1], 4.0 / (4.0 / 3.0), 1e-14);
}

TEST(DirichletBoundary, RefusesAMeshOfBoundaryOnly) {
  try {
    (void)compute_operator(make_rectangle(1, 1, 1, 1), kFixed);
    FAIL() << "no exception";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_request);
    EXPECT_STREQ(error.what(),
                 "boundary: all vertices lie on it; with Dirichlet conditions nothing is left");
  }
}

TEST(DirichletBoundary, FixesTheNodesOfHigherElementsOnEdgesToo) {
  for (const OperatorKind kind : {OperatorKind::p2, OperatorKind::p3}) {
    const Operator op = compute_operator(make_rectangle(1, 1, 1, 1),
                                         {.kind = kind, .boundary = BoundaryKind::dirichlet});
    // Within lie the nodes of the diagonal, and of cubic elements a centre each.
    EXPECT_EQ(op.stiffness.diagonal().count(), kind == OperatorKind::p2 ? 1 : 4) << to_word(kind);
  }
}

}  // namespace
}  // namespace timbre
