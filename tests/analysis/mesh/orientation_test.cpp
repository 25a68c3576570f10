#include "timbre/analysis/mesh/orientation.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <random>
#include <utility>

#include "timbre/datasets/analytic.h"

namespace timbre {
namespace {

TEST(OrientOutward, TurnsRandomlyFlippedFacesOfASphereBack) {
  const TriangleMesh sphere = make_sphere(5);
  TriangleMesh mixed = sphere;
  std::mt19937 random(1);
  for (Eigen::Index f = 0; f < mixed.faces.rows(); ++f) {
    if (random() % 2 == 0) std::swap(mixed.faces(f, 1), mixed.faces(f, 2));
  }
  const OrientedFaces result = orient_outward(mixed);
  EXPECT_EQ(result.orientation, Orientation::outward);
  for (Eigen::Index f = 0; f < mixed.faces.rows(); ++f) {
    const Eigen::RowVector3d a = sphere.vertices.row(result.faces(f, 0));
    const Eigen::RowVector3d b = sphere.vertices.row(result.faces(f, 1));
    EXPECT_GT(a.cross(b).dot(sphere.vertices.row(result.faces(f, 2))), 0.0);
  }
}

TEST(OrientOutward, DoesNotGuessForOpenOrNonManifoldSurfaces) {
  EXPECT_EQ(orient_outward(make_rectangle(1, 1, 2, 2)).orientation, Orientation::unknown);
  TriangleMesh fin = make_sphere(2);
  fin.vertices.conservativeResize(fin.vertices.rows() + 1, 3);
  fin.vertices.bottomRows(1) << 2, 2, 2;
  fin.faces.conservativeResize(fin.faces.rows() + 1, 3);
  fin.faces.bottomRows(1) << fin.faces(0, 0), fin.faces(0, 1),
      static_cast<std::int32_t>(fin.vertices.rows() - 1);
  EXPECT_EQ(orient_outward(fin).orientation, Orientation::unknown);
}

}  // namespace
}  // namespace timbre
