#include "timbre/analysis/operators/operator.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <string>

#include "timbre/analysis/core/error.h"
#include "timbre/datasets/analytic.h"
#include "timbre/tests/support/mesh_shapes.h"

namespace timbre {
namespace {

using Eigen::MatrixXd;

TriangleMesh right_triangle() { return make_mesh({{0, 0, 0}, {3, 0, 0}, {0, 4, 0}}, {{0, 1, 2}}); }

std::string message(const TriangleMesh& mesh, const OperatorOptions& options = {}) {
  try {
    (void)compute_operator(mesh, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "no exception";
}

class EveryOperator : public testing::TestWithParam<OperatorKind> {};

INSTANTIATE_TEST_SUITE_P(Kinds, EveryOperator, testing::ValuesIn(kOperatorKinds),
                         [](const auto& kind) { return to_word(kind.param); });

TEST_P(EveryOperator, IsSymmetricPositiveAndKillsConstants) {
  for (const TriangleMesh& mesh : {make_ellipsoid(1.0, 0.7, 2.0, 2), grid(4), moebius_strip(12)}) {
    const Operator op = compute_operator(mesh, {.kind = GetParam()});
    const MatrixXd W = op.stiffness;
    const MatrixXd M = op.mass;
    EXPECT_TRUE(W == W.transpose());
    EXPECT_TRUE(M == M.transpose());
    EXPECT_LT((W * Eigen::VectorXd::Ones(W.rows())).cwiseAbs().maxCoeff(),
              1e-13 * W.cwiseAbs().maxCoeff());
    const Eigen::SelfAdjointEigenSolver<MatrixXd> stiffness(W);
    EXPECT_GT(stiffness.eigenvalues()[0], -1e-13 * stiffness.eigenvalues().maxCoeff());
    EXPECT_GT(stiffness.eigenvalues()[1], 1e-6 * stiffness.eigenvalues().maxCoeff());
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatrixXd>(M).eigenvalues()[0], 0.0);
    EXPECT_EQ(op.kind, GetParam());
    EXPECT_EQ(op.vertices, mesh.vertices.rows());
    EXPECT_NEAR(op.area, M.sum(), 1e-12 * op.area);
    EXPECT_EQ(count_zeros(op), 1);
  }
}

TEST_P(EveryOperator, DoesNotFeelAFarOriginOrAnExtremeUnit) {
  const TriangleMesh near = make_ellipsoid(1.0, 0.7, 2.0, 4);
  const Operator reference = compute_operator(near, {.kind = GetParam()});
  const MatrixXd W = reference.stiffness;
  const bool has_units =
      reference.mass_kind != MassKind::degree && GetParam() != OperatorKind::graph;
  for (const double scale : {1e-30, 1e30, 1e-130, 1e130, 3.7}) {
    TriangleMesh scaled = near;
    scaled.vertices *= scale;
    const Operator op = compute_operator(scaled, {.kind = GetParam()});
    EXPECT_LT((MatrixXd(op.stiffness) - W).cwiseAbs().maxCoeff(), 1e-12) << scale;
    const double unit = has_units ? scale * scale : 1.0;
    EXPECT_LT((op.lumped_mass / unit - reference.lumped_mass).cwiseAbs().maxCoeff(),
              1e-12 * reference.lumped_mass.maxCoeff())
        << scale;
  }
  TriangleMesh far = near;
  far.vertices.array() += 1024.0;
  const Operator op = compute_operator(far, {.kind = GetParam()});
  EXPECT_LT((MatrixXd(op.stiffness) - W).cwiseAbs().maxCoeff(), 1e-10);
}

TEST_P(EveryOperator, LeavesUnusedVerticesOut) {
  const TriangleMesh mesh = make_ellipsoid(1.0, 0.7, 2.0, 3);
  TriangleMesh with;
  with.vertices.resize(mesh.vertices.rows() + 2, 3);
  with.vertices << 1e300, 0, 0, mesh.vertices, 5, 5, 5;
  with.faces = mesh.faces.array() + 1;
  const Operator bare = compute_operator(mesh, {.kind = GetParam()});
  const Operator op = compute_operator(with, {.kind = GetParam()});
  const Eigen::Index last = mesh.vertices.rows() + 1;
  for (const Eigen::Index unused : {Eigen::Index{0}, last}) {
    EXPECT_EQ(op.component[static_cast<std::size_t>(unused)], -1);
    EXPECT_EQ(op.lumped_mass[unused], 0.0);
    EXPECT_EQ(op.stiffness.col(unused).nonZeros(), 0);
    EXPECT_EQ(op.mass.col(unused).nonZeros(), 0);
  }
  EXPECT_NEAR(op.area, bare.area, 1e-12 * bare.area);
  EXPECT_NEAR(op.stiffness.norm(), bare.stiffness.norm(), 1e-12 * bare.stiffness.norm());
}

TEST_P(EveryOperator, SaysWhichMassesItHas) {
  for (const MassKind mass : kMassKinds) {
    const OperatorOptions options = {.kind = GetParam(), .mass = mass};
    const bool is_linear = GetParam() == OperatorKind::robust || GetParam() == OperatorKind::cotan;
    if (mass == mass_of({.kind = GetParam()}) || (is_linear && mass == MassKind::consistent)) {
      EXPECT_EQ(mass_of(options), mass);
      EXPECT_EQ(compute_operator(right_triangle(), options).mass_kind, mass);
    } else {
      EXPECT_EQ(message(right_triangle(), options), std::string("mass: ") + to_word(mass) +
                                                        " does not go with the operator " +
                                                        to_word(GetParam()) + ", whose mass is " +
                                                        to_word(mass_of({.kind = GetParam()})));
    }
  }
}

TEST(ComputeOperator, GivesTheTextbookMatricesOfOneTriangle) {
  const Operator op = compute_operator(right_triangle());
  MatrixXd W(3, 3);  // half cotangents: 2/3 opposite (0,2), 3/8 opposite (0,1), 0 opposite (1,2)
  W << 3.0 / 8 + 2.0 / 3, -2.0 / 3, -3.0 / 8, -2.0 / 3, 2.0 / 3, 0, -3.0 / 8, 0, 3.0 / 8;
  EXPECT_LT((MatrixXd(op.stiffness) - W).norm(), 1e-14);
  EXPECT_LT((MatrixXd(op.mass) - 2.0 * MatrixXd::Identity(3, 3)).norm(), 1e-14);
  EXPECT_NEAR(op.area, 6.0, 1e-14);
  EXPECT_EQ(op.mollified_by, 0.0);
}

TEST(ComputeOperator, ConsistentMassIsTheGalerkinMatrix) {
  const Operator op = compute_operator(right_triangle(), {.mass = MassKind::consistent});
  const MatrixXd expected = 0.5 * (MatrixXd::Ones(3, 3) + MatrixXd::Identity(3, 3));
  EXPECT_LT((MatrixXd(op.mass) - expected).norm(), 1e-14);
}

TEST(ComputeOperator, StaysPositiveOnZeroAreaFaces) {
  TriangleMesh mesh = make_rectangle(1.0, 1.0, 3, 3);
  mesh.vertices.row(5) = mesh.vertices.row(6);  // collapses an edge: two faces lose their area
  const Operator op = compute_operator(mesh);
  EXPECT_GT(op.mollified_by, 0.0);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> dense{MatrixXd(op.stiffness)};
  EXPECT_GT(dense.eigenvalues()[0], -1e-9 * dense.eigenvalues().maxCoeff());
  EXPECT_GT(dense.eigenvalues()[1], 1e-3);
  EXPECT_GT(op.lumped_mass.minCoeff(), 0.0);
}

TEST(ComputeOperator, LeavesOutRepeatedCornersAndUnusedVertices) {
  TriangleMesh mesh = right_triangle();
  mesh.vertices.conservativeResize(4, 3);
  mesh.vertices.row(3) << 9, 9, 9;
  mesh.faces.conservativeResize(2, 3);
  mesh.faces.row(1) << 1, 1, 3;
  const Operator op = compute_operator(mesh);
  EXPECT_EQ(op.component, (std::vector<std::int32_t>{0, 0, 0, -1}));
  EXPECT_EQ(op.lumped_mass[3], 0.0);
  EXPECT_NEAR(op.area, 6.0, 1e-14);
}

TEST(ComputeOperator, NumbersComponentsByTheirFirstVertex) {
  TriangleMesh mesh = right_triangle();
  mesh.vertices.conservativeResize(6, 3);
  mesh.vertices.bottomRows(3) = 2.0 * mesh.vertices.topRows(3);
  mesh.faces.resize(2, 3);
  mesh.faces << 3, 4, 5, 0, 1, 2;
  const Operator op = compute_operator(mesh);
  EXPECT_EQ(op.component, (std::vector<std::int32_t>{0, 0, 0, 1, 1, 1}));
  EXPECT_NEAR(op.component_area[0], 6.0, 1e-13);
  EXPECT_NEAR(op.component_area[1], 24.0, 1e-13);
}

TEST(ComputeOperator, SolvesATinyComponentBesideAHugeOne) {
  const TriangleMesh one = make_ellipsoid(1.0, 0.7, 2.0, 3);
  const Eigen::Index n = one.vertices.rows();
  TriangleMesh both;
  both.vertices.resize(2 * n, 3);
  both.vertices << one.vertices * 1e80, one.vertices * 1e-20;
  both.faces.resize(2 * one.faces.rows(), 3);
  both.faces << one.faces, (one.faces.array() + static_cast<std::int32_t>(n)).matrix();
  const Operator op = compute_operator(both);
  const MatrixXd W = op.stiffness;
  EXPECT_LT((W.topLeftCorner(n, n) - W.bottomRightCorner(n, n)).norm(), 1e-11);
  EXPECT_NEAR(op.component_area[1] * 1e40 / (op.component_area[0] * 1e-160), 1.0, 1e-12);
}

TEST(ComputeOperator, LeavesOutComponentsWithoutArea) {
  TriangleMesh mesh = right_triangle();
  mesh.vertices.conservativeResize(6, 3);
  mesh.vertices.bottomRows(3) << 1, 1, 1, 2, 2, 2, 3, 3, 3;
  mesh.faces.conservativeResize(2, 3);
  mesh.faces.row(1) << 3, 4, 5;
  for (const OperatorKind kind : kOperatorKinds) {
    const Operator op = compute_operator(mesh, {.kind = kind});
    EXPECT_EQ(op.components_left_out, 1) << to_word(kind);
    EXPECT_EQ(op.component_area.size(), 1) << to_word(kind);
    EXPECT_EQ(op.component[4], -1) << to_word(kind);
    EXPECT_EQ(op.mollified_by, 0.0) << to_word(kind);
  }
}

TEST(ComputeOperator, NamesTheFaceOrVertexThatIsWrong) {
  TriangleMesh mesh = right_triangle();
  mesh.faces(0, 2) = 3;
  EXPECT_EQ(message(mesh), "face 0: index 3 is out of range, the mesh has 3 vertices");
  mesh.faces(0, 2) = -1;
  EXPECT_EQ(message(mesh), "face 0: index -1 is out of range, the mesh has 3 vertices");
  mesh = right_triangle();
  mesh.vertices(1, 1) = std::nan("");
  EXPECT_EQ(message(mesh), "vertex 1: coordinate is not finite");
}

TEST(ComputeOperator, RefusesAMeshWithoutArea) {
  TriangleMesh mesh = right_triangle();
  mesh.vertices.setConstant(7.0);
  EXPECT_EQ(message(mesh), "faces: none has any area; a Laplacian needs at least one that has");
  mesh = right_triangle();
  mesh.vertices.row(2) = 0.5 * (mesh.vertices.row(0) + mesh.vertices.row(1));
  EXPECT_EQ(message(mesh), "faces: none has any area; a Laplacian needs at least one that has");
  mesh.faces << 0, 0, 1;
  EXPECT_EQ(message(mesh),
            "faces: none with three different corners; a Laplacian needs at least one");
  mesh.faces.resize(0, 3);
  EXPECT_EQ(message(mesh), "faces: there are none, only points; a Laplacian needs a surface");
}

TEST(ComputeOperator, RefusesAreasBeyondADouble) {
  TriangleMesh mesh = right_triangle();
  mesh.vertices *= 1e200;
  EXPECT_EQ(message(mesh),
            "component 0: its area is beyond the range of a double; scale the mesh to a unit of "
            "length nearer to its size");
  EXPECT_EQ(message(right_triangle(), {.mollification = -1.0}), "mollification: must be 0 or more");
}

TEST(Symmetrized, HasTheSameEigenvalues) {
  const Operator op = compute_operator(make_ellipsoid(1.0, 0.7, 2.0, 3));
  const MatrixXd S = symmetrized(op);
  EXPECT_TRUE(S == S.transpose());
  const Eigen::VectorXd plain = Eigen::SelfAdjointEigenSolver<MatrixXd>(S).eigenvalues();
  const Eigen::VectorXd general =
      Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(MatrixXd(op.stiffness), MatrixXd(op.mass))
          .eigenvalues();
  EXPECT_LT((plain - general).cwiseAbs().maxCoeff(), 1e-11 * plain.maxCoeff());
  EXPECT_THROW(
      (void)symmetrized(compute_operator(right_triangle(), {.mass = MassKind::consistent})), Error);
}

}  // namespace
}  // namespace timbre
