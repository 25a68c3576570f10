#include "timbre/datasets/isosurface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "timbre/analysis/mesh/orientation.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

const Eigen::AlignedBox3d kBox(Vector3d(-1.0, -1.0, -1.0), Vector3d(1.0, 1.0, 1.0));

ImplicitFunction ball(double radius) {
  return [radius](const Vector3d& p) {
    return ImplicitValue{p.norm() - radius, p.norm() > 0.0 ? p.normalized() : Vector3d::Zero()};
  };
}

class BallOfAnySize : public testing::TestWithParam<double> {};

TEST_P(BallOfAnySize, IsAClosedSphereWithItsPointsOnTheSurface) {
  const MirroredMesh sphere = make_isosurface(ball(GetParam()), kBox, 0.15);
  EXPECT_EQ(orient_outward(sphere.mesh).orientation, Orientation::outward);
  EXPECT_EQ(orient_outward(sphere.mesh).faces, sphere.mesh.faces);
  EXPECT_EQ(2 * sphere.mesh.vertices.rows() - sphere.mesh.faces.rows(), 4);
  for (Index v = 0; v < sphere.mesh.vertices.rows(); ++v) {
    EXPECT_NEAR(sphere.mesh.vertices.row(v).norm(), GetParam(), 1e-9);
  }
}
TEST_P(BallOfAnySize, IsOneInAnyTurnedLatticeWithoutMirrorSymmetry) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.9, Vector3d(1.0, 2.0, -0.5).normalized()));
  const TriangleMesh sphere = make_isosurface(ball(GetParam()), kBox, 0.15, turn);
  EXPECT_EQ(orient_outward(sphere).faces, sphere.faces);
  EXPECT_EQ(orient_outward(sphere).orientation, Orientation::outward);
  EXPECT_EQ(2 * sphere.vertices.rows() - sphere.faces.rows(), 4);
  EXPECT_LT((sphere.vertices.rowwise().norm().array() - GetParam()).abs().maxCoeff(), 1e-9);
  EXPECT_TRUE((sphere.vertices.col(0).array() != 0.0).all());
}

INSTANTIATE_TEST_SUITE_P(Radii, BallOfAnySize, testing::Values(0.25, 0.4, 0.5, 0.77, 0.9, 1.0));

TEST(MakeIsosurface, FindsTheHoleOfATorusAcrossThePlane) {
  const ImplicitFunction torus = [](const Vector3d& p) {
    const double around = std::max(std::hypot(p.x(), p.z()), 1e-9);
    const Vector3d spoke(p.x() / around, 0.0, p.z() / around);
    const Vector3d away = p - 0.7 * spoke;
    return ImplicitValue{away.norm() - 0.2, away.normalized()};
  };
  const MirroredMesh mesh = make_isosurface(torus, kBox, 0.1);
  EXPECT_EQ(orient_outward(mesh.mesh).orientation, Orientation::outward);
  EXPECT_EQ(2 * mesh.mesh.vertices.rows() - mesh.mesh.faces.rows(), 0);
}

}  // namespace
}  // namespace timbre
