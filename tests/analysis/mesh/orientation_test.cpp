#include "timbre/analysis/mesh/orientation.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>
#include <utility>

#include "timbre/datasets/analytic.h"

namespace timbre {
namespace {

TriangleMesh with_random_flips(TriangleMesh mesh) {
  std::mt19937 random(1);
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f) {
    if (random() % 2 == 0) std::swap(mesh.faces(f, 1), mesh.faces(f, 2));
  }
  return mesh;
}

void expect_outward(const TriangleMesh& sphere, const Faces& faces) {
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    const Eigen::RowVector3d a = sphere.vertices.row(faces(f, 0));
    const Eigen::RowVector3d b = sphere.vertices.row(faces(f, 1));
    ASSERT_GT(a.cross(b).dot(sphere.vertices.row(faces(f, 2))), 0.0) << f;
  }
}

TEST(OrientOutward, TurnsRandomlyFlippedFacesOfASphereBack) {
  const TriangleMesh sphere = make_sphere(5);
  const OrientedFaces result = orient_outward(with_random_flips(sphere));
  EXPECT_EQ(result.orientation, Orientation::outward);
  expect_outward(sphere, result.faces);
}

TEST(OrientOutward, DoesNotFeelAFarOrigin) {
  const TriangleMesh sphere = make_sphere(5);
  for (const double offset : {1e5, 1e6, 1e7, 1e8, -1e9}) {
    TriangleMesh far = with_random_flips(sphere);
    far.vertices.array() += offset;
    const OrientedFaces result = orient_outward(far);
    EXPECT_EQ(result.orientation, Orientation::outward) << offset;
    expect_outward(sphere, result.faces);
  }
}

TEST(OrientOutward, SeesPastASmallHole) {
  TriangleMesh sphere = make_sphere(12);
  sphere.faces.conservativeResize(sphere.faces.rows() - 4, 3);
  const OrientedFaces result = orient_outward(with_random_flips(sphere));
  EXPECT_EQ(result.orientation, Orientation::outward);
  expect_outward(sphere, result.faces);
}

TEST(OrientOutward, MakesAnOpenSurfaceConsistentAndSaysSo) {
  const TriangleMesh flat = make_rectangle(1, 1, 6, 6);
  const OrientedFaces result = orient_outward(with_random_flips(flat));
  EXPECT_EQ(result.orientation, Orientation::consistent);
  double side = 0.0;
  for (Eigen::Index f = 0; f < result.faces.rows(); ++f) {
    const Eigen::RowVector3d a = flat.vertices.row(result.faces(f, 0));
    const Eigen::RowVector3d b = flat.vertices.row(result.faces(f, 1));
    const Eigen::RowVector3d c = flat.vertices.row(result.faces(f, 2));
    const double z = (b - a).cross(c - a)[2];
    EXPECT_GE(side * z, 0.0);
    side = z;
  }
}

TEST(OrientOutward, KeepsTheSideThatMostFacesOfAnOpenSurfaceShow) {
  const TriangleMesh flat = make_rectangle(1, 1, 6, 6);
  TriangleMesh turned = flat;
  for (Eigen::Index f = 0; f < 20; ++f) std::swap(turned.faces(f, 1), turned.faces(f, 2));
  EXPECT_EQ(orient_outward(turned).faces, flat.faces);
}

TEST(OrientOutward, KnowsAOneSidedSurface) {
  // A strip of 20 cells, its ends joined with a half turn.
  TriangleMesh moebius;
  const int n = 20;
  moebius.vertices.setRandom(2 * n, 3);
  moebius.faces.resize(2 * n, 3);
  for (int i = 0; i < n; ++i) {
    const int a = 2 * i;
    const int c = i + 1 < n ? a + 2 : 1;
    const int d = i + 1 < n ? a + 3 : 0;
    moebius.faces.row(2 * i) << a, c, a + 1;
    moebius.faces.row(2 * i + 1) << a + 1, c, d;
  }
  EXPECT_EQ(orient_outward(moebius).orientation, Orientation::none);
}

}  // namespace
}  // namespace timbre
