#include "timbre/analysis/mesh/half_edge.h"

#include <gtest/gtest.h>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/mesh/diagnosis.h"
#include "timbre/tests/support/mesh_shapes.h"

namespace timbre {
namespace {

using Numbers = std::vector<std::int32_t>;

std::string refusal(const TriangleMesh& mesh) {
  try {
    (void)HalfEdgeMesh(mesh);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    return error.what();
  }
  return "no error";
}

TEST(BoundaryLoops, GoRoundAnOpenGridWithTheSurfaceOnTheLeft) {
  const HalfEdgeMesh mesh(grid(2));
  EXPECT_EQ(mesh.boundary_loops(), (std::vector<Numbers>{{0, 1, 2, 5, 8, 7, 6, 3}}));
}

TEST(BoundaryLoops, AreSortedByTheirSmallestVertex) {
  // Two triangles of which the second has the smaller vertex.
  const HalfEdgeMesh mesh(make_mesh(
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}}, {{3, 4, 5}, {2, 0, 1}}));
  EXPECT_EQ(mesh.boundary_loops(), (std::vector<Numbers>{{0, 1, 2}, {3, 4, 5}}));
}

TEST(BoundaryLoops, AreNoneOnAClosedSurface) {
  EXPECT_TRUE(HalfEdgeMesh(torus(5, 4)).boundary_loops().empty());
}

TEST(OneRing, GoesRoundCounterClockwise) {
  const HalfEdgeMesh mesh(grid(2));
  Numbers ring = mesh.one_ring(4);
  std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
  EXPECT_EQ(ring, (Numbers{0, 1, 5, 8, 7, 3}));
  EXPECT_EQ(mesh.one_ring(0), (Numbers{1, 4, 3}));
  EXPECT_EQ(mesh.one_ring(2), (Numbers{5, 1}));
}

TEST(OneRing, IsEmptyForAnUnusedVertexAndRefusesOthers) {
  TriangleMesh mesh = tetrahedron();
  mesh.vertices.conservativeResize(5, 3);
  mesh.vertices.row(4).setZero();
  EXPECT_TRUE(HalfEdgeMesh(mesh).one_ring(4).empty());
  EXPECT_TRUE(HalfEdgeMesh(mesh).boundary_loops().empty());
  EXPECT_THROW((void)HalfEdgeMesh(mesh).one_ring(5), Error);
  EXPECT_THROW((void)HalfEdgeMesh(mesh).one_ring(-1), Error);
}

TEST(HalfEdgeMesh, NamesWhatItCannotHold) {
  const std::string needed = "; half-edges need a manifold mesh";
  EXPECT_EQ(refusal(make_mesh({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}},
                              {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}})),
            "edge 0-1: three or more triangles share it" + needed);
  EXPECT_EQ(refusal(make_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}},
                              {{1, 2, 0}, {0, 3, 4}})),
            "vertex 0: its triangles form more than one fan" + needed);
  EXPECT_EQ(
      refusal(make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 2, 3}})),
      "edge 1-2: its two triangles are turned unlike" + needed);
  EXPECT_EQ(refusal(make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {1, 1, 2}})),
            "face 1: a corner is repeated" + needed);
}

TEST(Decimate, KeepsTheSphereASphere) {
  const TriangleMesh fine = sphere(4);
  const DecimatedMesh coarse = decimate(fine, 500);
  EXPECT_EQ(coarse.mesh.vertices.rows(), 500);
  ASSERT_EQ(coarse.original.size(), 500U);
  EXPECT_TRUE(std::is_sorted(coarse.original.begin(), coarse.original.end()));
  for (Eigen::Index i = 0; i < 500; ++i) {
    EXPECT_EQ(coarse.mesh.vertices.row(i),
              fine.vertices.row(coarse.original[static_cast<std::size_t>(i)]));
  }
  const Diagnosis found = diagnose(coarse.mesh);
  EXPECT_EQ(found.faces, 2 * 500 - 4);
  EXPECT_EQ(found.genus, 0);
  EXPECT_EQ(found.unused_vertices, 0);
  EXPECT_EQ(found.flipped_edges, 0);
  EXPECT_EQ(found.boundary_edges, 0);
  EXPECT_NEAR(found.area, 4 * std::numbers::pi, 0.02 * 4 * std::numbers::pi);
}

TEST(Decimate, LeavesASmallMeshAndDropsUnusedVertices) {
  TriangleMesh mesh = tetrahedron();
  mesh.vertices.conservativeResize(5, 3);
  mesh.vertices.row(4).setZero();
  const DecimatedMesh same = decimate(mesh, 10);
  EXPECT_EQ(same.original, (Numbers{0, 1, 2, 3}));
  EXPECT_EQ(same.mesh.faces, mesh.faces);
}

TEST(Decimate, StopsBeforeTheTopologyChanges) {
  const DecimatedMesh coarse = decimate(torus(12, 9), 4);
  EXPECT_GE(coarse.mesh.vertices.rows(), 7);  // no torus has fewer
  EXPECT_EQ(diagnose(coarse.mesh).genus, 1);
}

TEST(Decimate, DoesNotDependOnScale) {
  const TriangleMesh mesh = torus(20, 15);
  const Numbers expected = decimate(mesh, 100).original;
  for (const int power : {-300, 300}) {
    TriangleMesh scaled = mesh;
    scaled.vertices *= std::ldexp(1.0, power);
    EXPECT_EQ(decimate(scaled, 100).original, expected);
  }
}

TEST(Decimate, RefusesImpossibleRequests) {
  try {
    (void)decimate(tetrahedron(), 3);
    FAIL() << "no exception";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "target: asks for 3 vertices; at least 4 are needed");
  }
  EXPECT_THROW((void)decimate(moebius_strip(8), 5), Error);
}

}  // namespace
}  // namespace timbre
