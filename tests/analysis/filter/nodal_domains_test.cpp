#include "timbre/analysis/filter/nodal_domains.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "timbre/analysis/spectrum/spectrum.h"
#include "timbre/datasets/analytic.h"
#include "timbre/tests/support/mesh_shapes.h"
#include "timbre/tests/support/refused_request.h"
#include "timbre/tests/support/shapes.h"

namespace timbre {
namespace {

using std::numbers::pi;

// Vertices 0 to 4 in a zigzag, each triangle of three that follow each other.
Faces zigzag() { return (Faces(3, 3) << 0, 1, 2, 2, 1, 3, 2, 3, 4).finished(); }

NodalDomains domains_of(std::initializer_list<double> values) {
  return find_nodal_domains(zigzag(), Eigen::Map<const Eigen::VectorXd>(values.begin(), 5));
}

TEST(NodalDomains, AreNumberedByTheirFirstVertices) {
  const NodalDomains found = domains_of({-1.0, -2.0, 1.0, 3.0, -1.0});
  EXPECT_EQ(found.label, (std::vector<std::int32_t>{0, 0, 1, 1, 2}));
  EXPECT_EQ(found.count, 3);
  EXPECT_EQ(found.weak_count, 3);
}

TEST(NodalDomains, ZerosPartStrongOnesAndJoinWeakOnes) {
  const NodalDomains found = domains_of({1.0, 0.0, 0.0, 1.0, 1.0});
  EXPECT_EQ(found.label, (std::vector<std::int32_t>{0, -1, -1, 1, 1}));
  EXPECT_EQ(found.count, 2);
  EXPECT_EQ(found.weak_count, 1);
  const NodalDomains both = domains_of({1.0, 0.0, 0.0, -1.0, -1.0});
  EXPECT_EQ(both.count, 2);
  EXPECT_EQ(both.weak_count, 2);
}

TEST(NodalDomains, TakeRoundingForZero) {
  EXPECT_EQ(domains_of({1.0, -1e-9, 1e-9, -1.0, -1.0}).label,
            (std::vector<std::int32_t>{0, -1, -1, 1, 1}));
  EXPECT_EQ(domains_of({1.0, -1e-7, 1e-7, -1.0, -1.0}).label,
            (std::vector<std::int32_t>{0, 1, 0, 1, 1}));
  const Eigen::VectorXd exact = (Eigen::VectorXd(5) << 1.0, -1e-300, 1.0, 0.0, 1.0).finished();
  EXPECT_EQ(find_nodal_domains(zigzag(), exact, 0.0).label,
            (std::vector<std::int32_t>{0, 1, 0, -1, 0}));
}

TEST(NodalDomains, AreNoneOfNothing) {
  const NodalDomains found = domains_of({0.0, 0.0, 0.0, 0.0, 0.0});
  EXPECT_EQ(found.count, 0);
  EXPECT_EQ(found.weak_count, 0);
}

TEST(NodalDomains, DoNotRunAlongTrianglesWithARepeatedCorner) {
  Faces faces = zigzag();
  faces.row(1) << 2, 3, 3;
  EXPECT_EQ(find_nodal_domains(faces.topRows(2), Eigen::VectorXd::Ones(5)).count, 3);
}

// cos(i pi x) cos(j pi y) on the square: a chessboard of (i + 1)(j + 1) fields. Nodal lines run
// along vertices, where the cosine is rounding, and so cross at vertices.
TEST(NodalDomains, CountTheFieldsOfAChessboard) {
  const TriangleMesh mesh = make_rectangle(1.0, 1.0, 24, 24);
  for (const int i : {0, 1, 2, 3, 4, 6}) {
    for (const int j : {0, 1, 2, 3, 4, 6}) {
      const Eigen::VectorXd f = (i * pi * mesh.vertices.col(0)).array().cos() *
                                (j * pi * mesh.vertices.col(1)).array().cos();
      const NodalDomains found = find_nodal_domains(mesh.faces, f);
      EXPECT_EQ(found.count, (i + 1) * (j + 1)) << i << " " << j;
    }
  }
}

// Where they cross within a square, its diagonal joins two of the four fields there: of each of the
// i j crossings one.
TEST(NodalDomains, AreJoinedByADiagonalAtACrossing) {
  const TriangleMesh mesh = make_rectangle(1.0, 1.0, 30, 30);
  const Eigen::VectorXd f = (2.0 * pi * mesh.vertices.col(0)).array().cos() *
                            (2.0 * pi * mesh.vertices.col(1)).array().cos();
  EXPECT_EQ(find_nodal_domains(mesh.faces, f).count, 9 - 4);
}

// All eigenvalues i^2 / 1.69 + j^2 up to the 20th are simple. Where nodal lines cross, rounding
// decides which fields are joined.
TEST(NodalDomains, CountThoseOfComputedEigenfunctions) {
  const TriangleMesh mesh = make_rectangle(1.3, 1.0, 52, 40);
  struct Mode {
    double value;
    int i, j;
  };
  std::vector<Mode> known;
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) known.push_back({i * i / 1.69 + j * j, i, j});
  }
  std::sort(known.begin(), known.end(),
            [](const Mode& a, const Mode& b) { return a.value < b.value; });
  const Spectrum spectrum = compute_spectrum(compute_operator(mesh), {.count = 20});
  int without_crossings = 0;
  for (std::size_t k = 0; k < 20; ++k) {
    const auto [value, i, j] = known[k];
    const NodalDomains found =
        find_nodal_domains(mesh.faces, spectrum.vectors.col(static_cast<Eigen::Index>(k)));
    EXPECT_LE(found.count, static_cast<int>(k) + 1) << k;  // Courant
    EXPECT_LE(found.count, (i + 1) * (j + 1)) << k;
    EXPECT_GE(found.count, (i + 1) * (j + 1) - i * j) << k;
    if (i * j == 0) ++without_crossings;
  }
  EXPECT_GE(without_crossings, 8);
}

void expect_courant(const TriangleMesh& mesh, int count) {
  const Spectrum spectrum = compute_spectrum(compute_operator(mesh), {.count = count});
  for (int i = 0; i < count; ++i) {
    const NodalDomains found = find_nodal_domains(mesh.faces, spectrum.vectors.col(i));
    EXPECT_LE(found.weak_count, i + 1) << i;
    if (i < 2) {
      EXPECT_EQ(found.count, i + 1) << i;  // constant; orthogonal to it
    }
  }
}

TEST(NodalDomains, KeepCourantsBoundOnSurfaces) {
  expect_courant(make_lump(12), 60);
  expect_courant(make_sphere(10), 49);
  expect_courant(make_torus(2.0, 0.7, 40, 20), 40);
  expect_courant(make_disk(12), 40);
}

// An eigenfunction of two components lives on one.
TEST(NodalDomains, LieOnTheComponentOfTheirEigenfunction) {
  TriangleMesh mesh = make_rectangle(2.0, 1.0, 8, 4);
  const Eigen::Index n = mesh.vertices.rows();
  const Eigen::Index m = mesh.faces.rows();
  mesh.vertices.conservativeResize(2 * n, 3);
  mesh.vertices.bottomRows(n) = 3.0 * mesh.vertices.topRows(n);
  mesh.faces.conservativeResize(2 * m, 3);
  mesh.faces.bottomRows(m) = mesh.faces.topRows(m).array() + static_cast<std::int32_t>(n);
  const Spectrum spectrum = compute_spectrum(compute_operator(mesh), {.count = 3});
  const NodalDomains found = find_nodal_domains(mesh.faces, spectrum.vectors.col(2));
  EXPECT_EQ(found.count, 2);
  for (Eigen::Index v = 0; v < n; ++v) EXPECT_EQ(found.label[static_cast<std::size_t>(v)], -1);
}

TEST(NodalDomains, NeedAValueForEachCorner) {
  const auto refusal = [](const Eigen::VectorXd& f, double zero) {
    return refused_request([&] { (void)find_nodal_domains(zigzag(), f, zero); });
  };
  const std::string line =
      "nodal domains: need a value for each vertex and a threshold of at least 0";
  EXPECT_EQ(refusal(Eigen::VectorXd::Ones(4), 0.0), line);
  EXPECT_EQ(refusal(Eigen::VectorXd::Ones(5), -1.0), line);
}

}  // namespace
}  // namespace timbre
