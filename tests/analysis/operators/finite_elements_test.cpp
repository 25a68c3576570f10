#include "timbre/analysis/operators/finite_elements.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/operators/operator.h"
#include "timbre/analysis/spectrum/spectrum.h"
#include "timbre/datasets/analytic.h"
#include "timbre/tests/support/mesh_shapes.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kPi = std::numbers::pi;

class EveryDegree : public testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(Degrees, EveryDegree, testing::Values(1, 2, 3));

TEST_P(EveryDegree, NumbersVerticesThenEdgesThenCentres) {
  const int degree = GetParam();
  const TriangleMesh mesh = sphere(1);  // 42 vertices, 120 edges, 80 triangles
  const LagrangeNodes nodes = number_nodes(mesh.faces, 42, degree);
  EXPECT_EQ(nodes.size, 42 + (degree - 1) * 120 + (degree == 3 ? 80 : 0));
  EXPECT_EQ(nodes.edges.size(), 120U);
  EXPECT_EQ(nodes.of_face.leftCols(3), mesh.faces);
  std::set<std::int32_t> met(nodes.of_face.data(), nodes.of_face.data() + nodes.of_face.size());
  EXPECT_EQ(static_cast<Index>(met.size()), nodes.size);
  EXPECT_EQ(*met.begin(), 0);
  EXPECT_EQ(*met.rbegin(), nodes.size - 1);
}

TEST_P(EveryDegree, PutsNodesEvenlyOnEdgesFromTheSmallerVertexOn) {
  const int degree = GetParam();
  const TriangleMesh mesh = grid(3);
  const LagrangeNodes nodes = number_nodes(mesh.faces, mesh.vertices.rows(), degree);
  const Points places = node_positions(nodes, mesh.vertices);
  Index node = mesh.vertices.rows();
  for (const auto& [low, high] : nodes.edges) {
    ASSERT_LT(low, high);
    for (int step = 1; step < degree; ++step, ++node) {
      const Eigen::RowVector3d expected =
          mesh.vertices.row(low) +
          (mesh.vertices.row(high) - mesh.vertices.row(low)) * (double(step) / degree);
      EXPECT_LT((places.row(node) - expected).norm(), 1e-15) << node;
    }
  }
}

// What the elements are: polynomials of their degree are represented without error.
TEST_P(EveryDegree, SamplesPolynomialsExactly) {
  const int degree = GetParam();
  const TriangleMesh mesh = grid(2);
  const LagrangeNodes nodes = number_nodes(mesh.faces, mesh.vertices.rows(), degree);
  const auto f = [&](const auto& p) {
    return 1.0 + std::pow(p[0] - 2.0 * p[1], degree) - 0.3 * p[0];
  };
  VectorXd values(nodes.size);
  const Points places = node_positions(nodes, mesh.vertices);
  for (Index i = 0; i < nodes.size; ++i) values[i] = f(places.row(i));
  const SampledFunction sampled = sample_function(nodes, mesh.vertices, values, 4);
  EXPECT_EQ(sampled.mesh.faces.rows(), 16 * mesh.faces.rows());
  for (Index i = 0; i < sampled.values.size(); ++i) {
    EXPECT_NEAR(sampled.values[i], f(sampled.mesh.vertices.row(i)), 1e-13);
  }
  EXPECT_NEAR(twice_signed_area_z(sampled.mesh), 2.0, 1e-14);
}

TEST(NumberNodes, LeavesOutRepeatedCorners) {
  Faces faces(2, 3);
  faces << 0, 1, 1, 0, 1, 2;
  const LagrangeNodes nodes = number_nodes(faces, 3, 2);
  EXPECT_EQ(nodes.faces.rows(), 1);
  EXPECT_EQ(nodes.size, 6);
}

TEST(NumberNodes, RefusesOtherDegrees) {
  Faces faces(1, 3);
  faces << 0, 1, 2;
  for (const int degree : {0, 4}) {
    try {
      (void)number_nodes(faces, 3, degree);
      FAIL() << "no exception";
    } catch (const Error& error) {
      EXPECT_EQ(error.what(), "degree: " + std::to_string(degree) + " is not 1, 2 or 3");
    }
  }
}

struct Case {
  OperatorKind kind;
  MassKind mass;
  int cells;  ///< of the coarser of two meshes
  double order;
};

// Printed in test names.
void PrintTo(const Case& c, std::ostream* out) {
  *out << to_word(c.kind) << ' ' << to_word(c.mass);
}

class EveryElement : public testing::TestWithParam<Case> {
 protected:
  [[nodiscard]] double order(double coarse, double fine) const { return std::log2(coarse / fine); }
  [[nodiscard]] OperatorOptions options() const {
    return {.kind = GetParam().kind, .mass = GetParam().mass};
  }
};

INSTANTIATE_TEST_SUITE_P(Elements, EveryElement,
                         testing::Values(Case{OperatorKind::cotan, MassKind::lumped, 12, 2.0},
                                         Case{OperatorKind::cotan, MassKind::consistent, 12, 2.0},
                                         Case{OperatorKind::robust, MassKind::lumped, 12, 2.0},
                                         Case{OperatorKind::dec, MassKind::circumcentric, 12, 2.0},
                                         Case{OperatorKind::p2, MassKind::consistent, 6, 4.0},
                                         Case{OperatorKind::p3, MassKind::consistent, 4, 6.0}));

TEST_P(EveryElement, ConvergesWithItsOrderOnTheFlatTorus) {
  const auto error = [&](int n) {
    const IntrinsicMesh torus = make_flat_torus(n);
    const Operator op = compute_operator(torus.faces, torus.lengths, torus.vertices, options());
    const VectorXd values = compute_spectrum(op, {.count = 9}).values;
    EXPECT_NEAR(op.area, 1.0, 1e-13);
    return std::abs(values.segment(1, 4).mean() - 4.0 * kPi * kPi) +
           std::abs(values.segment(5, 4).mean() - 8.0 * kPi * kPi);
  };
  const int n = GetParam().cells;
  EXPECT_NEAR(order(error(n), error(2 * n)), GetParam().order, 0.2);
}

TEST_P(EveryElement, ConvergesWithItsOrderOnTheRectangleOfBothBoundaries) {
  for (const BoundaryKind boundary : {BoundaryKind::neumann, BoundaryKind::dirichlet}) {
    OperatorOptions with = options();
    with.boundary = boundary;
    const bool fixed = boundary == BoundaryKind::dirichlet;
    // pi^2 (i^2 + j^2 / 4): (0, 1) comes after the zero, (1, 1) first of Dirichlet's.
    const double exact = fixed ? 1.25 * kPi * kPi : 0.25 * kPi * kPi;
    const auto error = [&](int n) {
      const Operator op = compute_operator(make_rectangle(1.0, 2.0, n, 2 * n), with);
      EXPECT_EQ(count_zeros(op), fixed ? 0 : 1);
      return std::abs(compute_spectrum(op, {.count = 4}).values[fixed ? 0 : 1] - exact);
    };
    // One direction only changes in the Neumann function: fewer cells show the order.
    const int n = fixed ? GetParam().cells : GetParam().cells / 2;
    EXPECT_NEAR(order(error(n), error(2 * n)), GetParam().order, 0.3) << to_word(boundary);
  }
}

TEST(PolynomialElements, BoundEigenvaluesFromAbove) {
  const TriangleMesh mesh = make_rectangle(1.0, 1.0, 3, 3);
  const double first = kPi * kPi;
  double before = 1e9;
  for (const OperatorKind kind : {OperatorKind::cotan, OperatorKind::p2, OperatorKind::p3}) {
    const Operator op = compute_operator(mesh, {.kind = kind, .mass = MassKind::consistent});
    const double found = compute_spectrum(op, {.count = 3}).values[1];
    EXPECT_GT(found, first) << to_word(kind);
    EXPECT_LT(found, before) << to_word(kind);
    before = found;
  }
}

TEST(PolynomialElements, AreTheSameWhateverWayFacesAreTurnedAndNumbered) {
  TriangleMesh mesh = make_ellipsoid(1.0, 0.7, 2.0, 3);
  TriangleMesh turned = mesh;
  for (Index f = 0; f < turned.faces.rows(); f += 2) {
    std::swap(turned.faces(f, 0), turned.faces(f, 1));
  }
  for (const OperatorKind kind : {OperatorKind::p2, OperatorKind::p3}) {
    const auto values = [&](const TriangleMesh& of) {
      return compute_spectrum(compute_operator(of, {.kind = kind}), {.count = 20}).values;
    };
    EXPECT_LT((values(mesh) - values(turned)).cwiseAbs().maxCoeff(), 1e-9) << to_word(kind);
  }
}

}  // namespace
}  // namespace timbre
