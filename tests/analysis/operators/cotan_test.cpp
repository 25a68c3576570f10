#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/operators/operator.h"
#include "timbre/datasets/analytic.h"

namespace timbre {
namespace {

using Eigen::MatrixXd;

TriangleMesh right_triangle() {
  TriangleMesh mesh;
  mesh.vertices.resize(3, 3);
  mesh.vertices << 0, 0, 0, 3, 0, 0, 0, 4, 0;
  mesh.faces.resize(1, 3);
  mesh.faces << 0, 1, 2;
  return mesh;
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

TEST(ComputeOperator, IsSymmetricAndKillsConstants) {
  const Operator op = compute_operator(make_ellipsoid(1.0, 0.7, 2.0, 8));
  EXPECT_EQ(MatrixXd(op.stiffness), MatrixXd(op.stiffness).transpose());
  EXPECT_LT((op.stiffness * Eigen::VectorXd::Ones(op.stiffness.rows())).cwiseAbs().maxCoeff(),
            1e-13);
}

TEST(ComputeOperator, DoesNotFeelAFarOriginOrAnExtremeUnit) {
  const TriangleMesh near = make_ellipsoid(1.0, 0.7, 2.0, 4);
  const Operator reference = compute_operator(near);
  for (const double scale : {1e-30, 1e30, 3.7}) {
    TriangleMesh scaled = near;
    scaled.vertices *= scale;
    const Operator op = compute_operator(scaled);
    EXPECT_LT((MatrixXd(op.stiffness) - MatrixXd(reference.stiffness)).norm(), 1e-11) << scale;
    EXPECT_NEAR(op.area / (reference.area * scale * scale), 1.0, 1e-12) << scale;
  }
  TriangleMesh far = near;
  far.vertices.array() += 1024.0;
  EXPECT_LT((MatrixXd(compute_operator(far).stiffness) - MatrixXd(reference.stiffness)).norm(),
            1e-10);
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

TEST(ComputeOperator, DoesNotFeelAnUnusedVertexFarAway) {
  TriangleMesh mesh = make_ellipsoid(1.0, 0.7, 2.0, 4);
  const MatrixXd before = compute_operator(mesh).stiffness;
  for (const double far : {1e12, 1e17, 1e300}) {
    TriangleMesh with = mesh;
    with.vertices.conservativeResize(mesh.vertices.rows() + 1, 3);
    with.vertices.bottomRows(1).setConstant(far);
    const MatrixXd after = compute_operator(with).stiffness;
    EXPECT_LT((after.topLeftCorner(before.rows(), before.cols()) - before).norm(), 1e-12) << far;
  }
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

TEST(ComputeOperator, NamesTheFaceOrVertexThatIsWrong) {
  const auto message = [](const TriangleMesh& mesh) -> std::string {
    try {
      (void)compute_operator(mesh);
    } catch (const Error& error) {
      return error.what();
    }
    return "no exception";
  };
  TriangleMesh mesh = right_triangle();
  mesh.faces(0, 2) = 3;
  EXPECT_EQ(message(mesh), "face 0: index 3 is out of range, the mesh has 3 vertices");
  mesh = right_triangle();
  mesh.vertices(1, 1) = std::nan("");
  EXPECT_EQ(message(mesh), "vertex 1: coordinate is not finite");
  mesh = right_triangle();
  mesh.vertices.row(2) = 0.5 * (mesh.vertices.row(0) + mesh.vertices.row(1));
  EXPECT_EQ(message(mesh),
            "faces: no face of component 0 has area; a Laplacian needs at least one");
}

TEST(ComputeOperator, RefusesAMeshWithoutArea) {
  TriangleMesh mesh = right_triangle();
  mesh.vertices.setConstant(7.0);
  EXPECT_THROW((void)compute_operator(mesh), Error);
  mesh = right_triangle();
  mesh.faces << 0, 0, 1;
  try {
    (void)compute_operator(mesh);
    FAIL() << "no exception";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "faces: none with three different corners; a Laplacian needs at least one");
  }
}

}  // namespace
}  // namespace timbre
