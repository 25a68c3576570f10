#include <gtest/gtest.h>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/mesh/detail/writers.h"
#include "timbre/analysis/mesh/read_mesh.h"
#include "timbre/tests/support/mesh_shapes.h"
#include "timbre/tests/support/refused_request.h"

namespace timbre::detail {
namespace {

// The corners of all facets, one after the other.
Points corners_of(const TriangleMesh& mesh) {
  Points corners(mesh.faces.size(), 3);
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f) {
    for (Eigen::Index k = 0; k < 3; ++k)
      corners.row(3 * f + k) = mesh.vertices.row(mesh.faces(f, k));
  }
  return corners;
}

TEST(StlBytes, ReadsBackTheSameFacetsAsFloats) {
  TriangleMesh mesh = torus(7, 5);
  mesh.faces.row(3) << 2, 2, 1;
  mesh.vertices.row(0) << 1e-45, -3e38, 3e38;
  const TriangleMesh back = read_mesh_bytes(stl_bytes(mesh), "m.stl").mesh;
  EXPECT_EQ(corners_of(back), corners_of(mesh).cast<float>().cast<double>());
  EXPECT_EQ(back.vertices.rows(), mesh.vertices.rows());
}

TEST(StlBytes, WritesUnitNormalsAndNoneWithoutArea) {
  const std::string bytes =
      stl_bytes(make_mesh({{0, 0, 0}, {1e-20, 0, 0}, {0, 1e-20, 0}}, {{0, 1, 2}, {1, 1, 1}}));
  EXPECT_EQ(bytes.size(), 84U + 2 * 50U);
  EXPECT_EQ(bytes.substr(0, 18), "created by timbre ");
  EXPECT_EQ(bytes.substr(84, 12), std::string("\0\0\0\0\0\0\0\0\0\0\x80\x3f", 12));
  EXPECT_EQ(bytes.substr(134, 12), std::string(12, '\0'));
}

TEST(StlBytes, RefusesWhatTheFormatCannotHold) {
  EXPECT_EQ(refused_request([] {
              (void)stl_bytes(make_mesh({{0, 0, 0}}, {}));
            }),
            "output: a mesh without faces is nothing that .stl holds; .ply keeps it");
  EXPECT_EQ(refused_request([] {
              (void)stl_bytes(make_mesh({{1e39, 0, 0}}, {{0, 0, 0}}));
            }),
            "output: a coordinate is beyond the range of a float; .ply keeps it");
}

}  // namespace
}  // namespace timbre::detail
