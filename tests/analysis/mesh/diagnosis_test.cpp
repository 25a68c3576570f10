#include "timbre/analysis/mesh/diagnosis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "timbre/tests/support/mesh_shapes.h"

namespace timbre {
namespace {

TriangleMesh join(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh both;
  both.vertices.resize(a.vertices.rows() + b.vertices.rows(), 3);
  both.vertices << a.vertices, b.vertices;
  both.faces.resize(a.faces.rows() + b.faces.rows(), 3);
  both.faces << a.faces, (b.faces.array() + static_cast<std::int32_t>(a.vertices.rows())).matrix();
  return both;
}

TEST(Diagnose, SeesASphereInATetrahedron) {
  const Diagnosis found = diagnose(tetrahedron());
  EXPECT_EQ(found.vertices, 4);
  EXPECT_EQ(found.faces, 4);
  EXPECT_EQ(found.components, 1);
  EXPECT_EQ(found.boundary_loops, 0);
  EXPECT_EQ(found.genus, 0);
  EXPECT_TRUE(found.manifold);
  EXPECT_TRUE(found.orientable);
  EXPECT_DOUBLE_EQ(found.area, 1.5 + std::sqrt(3.0) / 2.0);
  EXPECT_DOUBLE_EQ(found.volume.value(), 1.0 / 6.0);
}

TEST(Diagnose, CountsTheHandleOfATorus) {
  const Diagnosis found = diagnose(torus(60, 40));
  EXPECT_EQ(found.genus, 1);
  const double pi = std::numbers::pi;
  EXPECT_NEAR(found.area, 8 * pi * pi, 0.6);
  EXPECT_NEAR(found.volume.value(), 4 * pi * pi, 0.4);
}

TEST(Diagnose, CountsBoundariesOfAPlane) {
  TriangleMesh sheet = grid(4);
  EXPECT_EQ(diagnose(sheet).boundary_loops, 1);
  EXPECT_EQ(diagnose(sheet).boundary_edges, 16);
  EXPECT_FALSE(diagnose(sheet).volume.has_value());
  // A hole in the middle: without the two triangles of one inner square.
  Faces pierced(sheet.faces.rows() - 2, 3);
  pierced << sheet.faces.topRows(10), sheet.faces.bottomRows(sheet.faces.rows() - 12);
  sheet.faces = pierced;
  EXPECT_EQ(diagnose(sheet).boundary_loops, 2);
  EXPECT_EQ(diagnose(sheet).genus, 0);
}

TEST(Diagnose, KnowsAMoebiusStrip) {
  const Diagnosis found = diagnose(moebius_strip(12));
  EXPECT_FALSE(found.orientable);
  EXPECT_TRUE(found.manifold);
  EXPECT_EQ(found.boundary_loops, 1);
  EXPECT_EQ(found.genus, 1);  // one cross-cap
  EXPECT_GT(found.flipped_edges, 0);
}

TEST(Diagnose, FindsTheSpineOfABook) {
  const Diagnosis found = diagnose(make_mesh(
      {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}}, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}));
  EXPECT_FALSE(found.manifold);
  EXPECT_EQ(found.nonmanifold_edges, 1);
  EXPECT_EQ(found.first_nonmanifold_edges, (std::vector<std::array<std::int32_t, 2>>{{0, 1}}));
  EXPECT_EQ(found.nonmanifold_vertices, 2);
  EXPECT_EQ(found.boundary_edges, 6);
  EXPECT_EQ(found.components, 1);
  EXPECT_FALSE(found.genus.has_value());
}

TEST(Diagnose, FindsABowTie) {
  const Diagnosis found = diagnose(make_mesh(
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}));
  EXPECT_FALSE(found.manifold);
  EXPECT_EQ(found.nonmanifold_edges, 0);
  EXPECT_EQ(found.nonmanifold_vertices, 1);
  EXPECT_EQ(found.first_nonmanifold_vertices, std::vector<std::int32_t>{0});
  EXPECT_EQ(found.components, 1);
  EXPECT_EQ(found.boundary_loops, 2);
}

TEST(Diagnose, TakesComponentsApart) {
  const Diagnosis found = diagnose(join(tetrahedron(), join(grid(2), tetrahedron())));
  EXPECT_EQ(found.components, 3);
  EXPECT_TRUE(found.manifold);
  EXPECT_FALSE(found.genus.has_value());
}

TEST(Diagnose, AddsVolumesWhicheverWayTrianglesAreTurned) {
  TriangleMesh mesh = join(tetrahedron(), tetrahedron());
  std::swap(mesh.faces(2, 0), mesh.faces(2, 1));
  const Diagnosis found = diagnose(mesh);
  EXPECT_EQ(found.flipped_edges, 3);
  EXPECT_TRUE(found.orientable);
  EXPECT_DOUBLE_EQ(found.volume.value(), 2.0 / 6.0);
}

TEST(Diagnose, SubtractsACavity) {
  TriangleMesh mesh = join(tetrahedron(), tetrahedron());
  mesh.vertices.bottomRows(4) *= 0.5;
  mesh.faces.bottomRows(4).col(0).swap(mesh.faces.bottomRows(4).col(1));
  EXPECT_DOUBLE_EQ(diagnose(mesh).volume.value(), (1.0 - 0.125) / 6.0);
}

TEST(Diagnose, CountsOddFacesAndUnusedVertices) {
  const Diagnosis found =
      diagnose(make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}, {9, 9, 9}, {8, 8, 8}},
                         {{0, 1, 2}, {2, 1, 0}, {0, 1, 3}, {5, 5, 0}, {1, 2, 0}}));
  EXPECT_EQ(found.duplicate_faces, 2);
  EXPECT_EQ(found.first_duplicate_faces, (std::vector<std::int32_t>{1, 4}));
  EXPECT_EQ(found.degenerate_faces, 2);
  EXPECT_EQ(found.first_degenerate_faces, (std::vector<std::int32_t>{2, 3}));
  EXPECT_EQ(found.unused_vertices, 2);
  EXPECT_EQ(found.first_unused_vertices, (std::vector<std::int32_t>{4, 5}));
  EXPECT_DOUBLE_EQ(found.area, 1.5);
}

TEST(Diagnose, ListsOnlyTheFirstPlaces) {
  TriangleMesh mesh = grid(4);
  mesh.faces.resize(0, 3);
  const Diagnosis found = diagnose(mesh);
  EXPECT_EQ(found.unused_vertices, 25);
  EXPECT_EQ(found.first_unused_vertices, (std::vector<std::int32_t>{0, 1, 2, 3, 4}));
}

TEST(Diagnose, TakesAnEmptyMesh) {
  const Diagnosis found = diagnose({});
  EXPECT_EQ(found.vertices, 0);
  EXPECT_EQ(found.components, 0);
  EXPECT_EQ(found.area, 0.0);
  EXPECT_FALSE(found.genus.has_value());
  EXPECT_FALSE(found.volume.has_value());
}

TEST(Diagnose, DoesNotDependOnTheOrderOfVerticesAndFaces) {
  const TriangleMesh mesh = join(torus(7, 5), join(moebius_strip(9), grid(3)));
  const Diagnosis before = diagnose(mesh);
  std::mt19937 random(2);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<std::int32_t> number(static_cast<std::size_t>(mesh.vertices.rows()));
    std::iota(number.begin(), number.end(), 0);
    std::shuffle(number.begin(), number.end(), random);
    std::vector<std::int32_t> rows(static_cast<std::size_t>(mesh.faces.rows()));
    std::iota(rows.begin(), rows.end(), 0);
    std::shuffle(rows.begin(), rows.end(), random);
    TriangleMesh shuffled = mesh;
    for (Eigen::Index v = 0; v < mesh.vertices.rows(); ++v) {
      shuffled.vertices.row(number[static_cast<std::size_t>(v)]) = mesh.vertices.row(v);
    }
    for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f) {
      for (Eigen::Index k = 0; k < 3; ++k) {
        shuffled.faces(f, (k + trial) % 3) =
            number[static_cast<std::size_t>(mesh.faces(rows[static_cast<std::size_t>(f)], k))];
      }
    }
    const Diagnosis after = diagnose(shuffled);
    EXPECT_EQ(after.components, before.components);
    EXPECT_EQ(after.boundary_loops, before.boundary_loops);
    EXPECT_EQ(after.manifold, before.manifold);
    EXPECT_EQ(after.orientable, before.orientable);
    EXPECT_NEAR(after.area, before.area, 1e-12 * before.area);
  }
}

TEST(Diagnose, IsNotMisledByScale) {
  for (const double scale : {1e-200, 1e-100, 1e140}) {
    TriangleMesh mesh = torus(8, 6);
    mesh.vertices *= scale;
    const Diagnosis found = diagnose(mesh);
    EXPECT_EQ(found.degenerate_faces, 0);
    EXPECT_EQ(found.genus, 1);
  }
}

TEST(Diagnose, MeasuresAnglesAndEdges) {
  const Diagnosis found = diagnose(make_mesh({{0, 0, 0}, {3, 0, 0}, {0, 4, 0}}, {{0, 1, 2}}));
  EXPECT_DOUBLE_EQ(found.smallest_angle, std::atan2(3, 4) * 180 / std::numbers::pi);
  EXPECT_DOUBLE_EQ(found.shortest_edge, 3.0);
  EXPECT_DOUBLE_EQ(found.longest_edge, 5.0);
  EXPECT_DOUBLE_EQ(found.mean_edge, 4.0);
  EXPECT_EQ(found.thin_faces, 0);
  EXPECT_NEAR(diagnose(octahedron()).smallest_angle, 60.0, 1e-12);
}

TEST(Diagnose, NamesThinTriangles) {
  // The second is a needle, the third has no area, the fourth repeats a corner.
  const TriangleMesh mesh = make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 1e-5, 0}, {2, 0, 0}},
                                      {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}, {2, 2, 1}});
  const Diagnosis found = diagnose(mesh);
  EXPECT_EQ(found.thin_faces, 1);
  EXPECT_EQ(found.first_thin_faces, (std::vector<std::int32_t>{1}));
  EXPECT_EQ(found.degenerate_faces, 2);
  EXPECT_EQ(found.smallest_angle, 0.0);
}

TEST(Diagnose, AnglesDoNotDependOnScale) {
  for (const double scale : {1e-300, 1e-150, 1e150, 1e300}) {
    TriangleMesh mesh = tetrahedron();
    mesh.vertices *= scale;
    EXPECT_NEAR(diagnose(mesh).smallest_angle, 45.0, 1e-12) << scale;
    EXPECT_NEAR(diagnose(mesh).longest_edge / scale, std::sqrt(2.0), 1e-12) << scale;
    EXPECT_EQ(diagnose(mesh).thin_faces, 0) << scale;
  }
}

TEST(Diagnose, CountsVerticesAtThePlaceOfEarlierOnes) {
  const Diagnosis found = diagnose(join(tetrahedron(), tetrahedron()));
  EXPECT_EQ(found.coincident_vertices, 4);
  EXPECT_EQ(found.first_coincident_vertices, (std::vector<std::int32_t>{4, 5, 6, 7}));
}

TEST(Diagnose, TellsHowManyDigitsAFarOriginLeaves) {
  TriangleMesh mesh = tetrahedron();
  EXPECT_GT(diagnose(mesh).digits, 15.0);
  mesh.vertices.array() += 1e10;
  EXPECT_NEAR(diagnose(mesh).digits, 5.7, 0.2);
  mesh.vertices.setZero();
  EXPECT_EQ(diagnose(mesh).digits, 0.0);
}

TEST(Diagnose, ListsAsManyPlacesAsAskedFor) {
  EXPECT_EQ(diagnose(grid(4)).first_boundary_edges.size(), 5U);
  EXPECT_EQ(diagnose(grid(4), 100).first_boundary_edges.size(), 16U);
}

}  // namespace
}  // namespace timbre
