#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "timbre/analysis/mesh/read_mesh.h"
#include "timbre/analysis/mesh/write_mesh.h"
#include "timbre/analysis/spectrum/spectrum.h"
#include "timbre/datasets/analytic.h"
#include "timbre/tests/support/mesh_shapes.h"
#include "timbre/tests/support/odd_shapes.h"
#include "timbre/tests/support/shapes.h"
#include "timbre/tests/support/shared_data.h"
#include "timbre/tests/support/temporary_folder.h"

// What must not change a spectrum, on meshes with every oddity.

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int kCount = 30;

TriangleMesh with_repeats_and_strays(TriangleMesh mesh) {
  const Index n = mesh.vertices.rows();
  const Index m = mesh.faces.rows();
  mesh.vertices.conservativeResize(n + 3, 3);
  mesh.vertices.bottomRows(3) << 1, 0, 0, 0, 1, 0, 0, 0, 1;
  mesh.faces.conservativeResize(m + 7, 3);
  mesh.faces.middleRows(m, 5) = mesh.faces.topRows(5);
  mesh.faces.bottomRows(2) << 0, 0, 1, 3, 3, 3;
  return mesh;
}

VectorXd spectrum_of(const TriangleMesh& mesh) {
  return compute_spectrum(compute_operator(mesh), {.count = kCount}).values;
}

// Relative to the largest.
void expect_same(const VectorXd& found, const VectorXd& expected, double tolerance,
                 const std::string& change) {
  ASSERT_EQ(found.size(), expected.size()) << change;
  EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), tolerance * expected.maxCoeff()) << change;
}

TriangleMesh moved(const TriangleMesh& mesh, const Eigen::Affine3d& by) {
  TriangleMesh result = mesh;
  for (auto row : result.vertices.rowwise()) {
    row = (by * Eigen::Vector3d(row.transpose())).transpose();
  }
  return result;
}

struct Sample {
  std::string name;
  TriangleMesh mesh;
};

std::vector<Sample> samples() {
  return {{"lump", make_lump(8)},
          {"cut into needles", with_cut_edges(make_lump(8), 60, 1e-7)},
          {"cut into faces without area", with_cut_edges(make_lump(8), 60, 0.0)},
          {"book", make_book(5, 12, true)},
          {"moebius strip", moebius_strip(60)},
          {"repeats and strays", with_repeats_and_strays(make_lump(6))},
          {"parts", joined({make_lump(5), grid(8), make_book(3, 8), octahedron()})},
          {"two triangles", make_rectangle(1.0, 2.0, 1, 1)}};
}

// After flips, which diagonal of four points on a circle is left hangs on the order of faces; its
// weight is 0, but the areas about its ends are not those of the other.
void expect_same_with_faces_shuffled(const TriangleMesh& mesh, const VectorXd& values) {
  const TriangleMesh shuffled = with_faces_shuffled(mesh, 4);
  const Operator before = compute_operator(mesh);
  const Operator after = compute_operator(shuffled);
  EXPECT_LT((after.stiffness - before.stiffness).norm(), 1e-9 * before.stiffness.norm());
  EXPECT_NEAR(after.area, before.area, 1e-9 * before.area);
  if ((after.lumped_mass - before.lumped_mass).norm() > 1e-9 * before.lumped_mass.norm()) {
    EXPECT_GT(before.flips, 0);
    return;
  }
  expect_same(spectrum_of(shuffled), values, 1e-9, "faces turned, reordered");
}

void expect_unchanged_by_everything(const Sample& sample) {
  SCOPED_TRACE(sample.name);
  const TriangleMesh& mesh = sample.mesh;
  const VectorXd values = spectrum_of(mesh);
  const double size =
      (mesh.vertices.colwise().maxCoeff() - mesh.vertices.colwise().minCoeff()).maxCoeff();

  TriangleMesh scaled = mesh;
  scaled.vertices *= 3.7;
  expect_same(spectrum_of(scaled) * 3.7 * 3.7, values, 1e-9, "scale 3.7");

  const Eigen::AngleAxisd turn(1.1, Eigen::Vector3d(1, -2, 3).normalized());
  expect_same(spectrum_of(moved(mesh, Eigen::Affine3d(turn))), values, 1e-9, "turned");
  const Eigen::Translation3d away(size * Eigen::Vector3d(3, -2, 5));
  expect_same(spectrum_of(moved(mesh, Eigen::Affine3d(away))), values, 1e-8,
              "moved");  // costs digits of the coordinates

  expect_same(spectrum_of(renumbered(mesh, random_order(mesh.vertices.rows(), 4))), values, 1e-9,
              "renumbered");
  expect_same_with_faces_shuffled(mesh, values);

  const TemporaryFolder folder;
  for (const char* name : {"a.off", "a.obj", "a.ply"}) {
    const std::filesystem::path path = folder.path() / name;
    write_mesh(mesh, path.string());
    expect_same(spectrum_of(read_mesh(path.string()).mesh), values, 1e-12, name);
  }
}

TEST(AnyMesh, HasASpectrumThatNothingButItsShapeChanges) {
  for (const Sample& sample : samples()) expect_unchanged_by_everything(sample);
}

TEST(AnyMesh, KeepsItsSpectrumInAnyUnitOfLength) {
  for (const Sample& sample : samples()) {
    if (sample.name == "book" || sample.name == "parts") continue;  // below
    const VectorXd values = spectrum_of(sample.mesh);
    for (const double unit : {1e-30, 1e-12, 1e12, 1e30}) {
      TriangleMesh scaled = sample.mesh;
      scaled.vertices *= unit;
      expect_same(spectrum_of(scaled) * unit * unit, values, 1e-9,
                  sample.name + " x " + std::to_string(unit));
    }
  }
}

// Last digits may decide the order of faces about an edge; these have no ties.
TEST(AnyMesh, KeepsItsSpectrumInAnyUnitOfLengthWhereSheetsMeet) {
  for (const int pages : {3, 5}) {
    const VectorXd values = spectrum_of(make_book(pages, 12, true));
    for (const double unit : {1e-30, 1e30}) {
      TriangleMesh scaled = make_book(pages, 12, true);
      scaled.vertices *= unit;
      expect_same(spectrum_of(scaled) * unit * unit, values, 1e-9, std::to_string(unit));
    }
  }
}

TEST(AnyMesh, HasASpectrumNearTheEndsOfTheRangeOfADouble) {
  const VectorXd values = spectrum_of(make_lump(5));
  for (const double unit : {1e-135, 1e135}) {
    TriangleMesh scaled = make_lump(5);
    scaled.vertices *= unit;
    expect_same(spectrum_of(scaled) * unit * unit, values, 1e-9, std::to_string(unit));
  }
}

TEST(AnyMesh, FindsNothingNewFarFromTheOrigin) {
  const TriangleMesh mesh = make_ellipsoid(1.0, 0.7, 2.0, 8);
  const VectorXd values = spectrum_of(mesh);
  TriangleMesh far = mesh;
  far.vertices.array() += 1e6;  // ten digits are left
  expect_same(spectrum_of(far), values, 1e-8, "1e6");
}

TEST(AnyMesh, SolvesFiveTetrahedraOfAllSizes) {
  std::vector<TriangleMesh> parts;
  std::vector<double> expected(5, 0.0);
  const VectorXd one = spectrum_of(tetrahedron());
  for (int i = 0; i < 5; ++i) {
    const double size = 1.0 + 0.5 * i;
    parts.push_back(tetrahedron());
    parts.back().vertices *= size;
    for (const double value : one.tail(3)) expected.push_back(value / (size * size));
  }
  std::sort(expected.begin(), expected.end());
  const Spectrum found = compute_spectrum(compute_operator(joined(parts)), {.count = 50});
  EXPECT_EQ(found.zeros, 5);
  expect_same(found.values, Eigen::Map<VectorXd>(expected.data(), 20), 1e-12, "five");
  // No function lives on two of them.
  for (Index i = 0; i < found.vectors.cols(); ++i) {
    int parts_met = 0;
    for (Index part = 0; part < 5; ++part) {
      if (found.vectors.col(i).segment(4 * part, 4).cwiseAbs().maxCoeff() > 0.0) ++parts_met;
    }
    EXPECT_EQ(parts_met, 1) << i;
  }
}

TEST(AnyMesh, TwoTrianglesBesideABigBodyAddTheirZeroOnly) {
  const TriangleMesh big = make_lump(10);
  TriangleMesh tiny = make_rectangle(1e-3, 1e-3, 1, 1);
  const VectorXd alone = spectrum_of(big);
  const VectorXd both = spectrum_of(joined({tiny, big}));
  EXPECT_EQ(both[0], 0.0);
  EXPECT_EQ(both[1], 0.0);
  expect_same(both.tail(kCount - 2), alone.segment(1, kCount - 2), 1e-9, "beside");
}

TEST(AnyMesh, GivesAsManyPairsAsVerticesInUse) {
  TriangleMesh mesh = tetrahedron();
  mesh.vertices.conservativeResize(6, 3);
  mesh.vertices.bottomRows(2).setZero();
  const Spectrum found = compute_spectrum(compute_operator(mesh), {.count = 50});
  EXPECT_EQ(found.values.size(), 4);
  EXPECT_EQ(found.vectors.rows(), 6);
  EXPECT_EQ(found.vectors.bottomRows(2).cwiseAbs().maxCoeff(), 0.0);
}

// Real files of all kinds, where they are present.
TEST(AnyMesh, KeepsTheSpectrumOfRealMeshes) {
  TIMBRE_NEEDS_SHARED_DATA("messy");
  // Many faces about one edge lie upon each other there: nothing but numbers decides their order.
  const std::vector<std::string> tied = {"chair_two_sided.obj"};
  for (const auto& entry : std::filesystem::directory_iterator(shared_data() / "messy")) {
    const std::string name = entry.path().filename().string();
    if (!entry.is_regular_file() || name == "README.md" || name == "facts.tsv") continue;
    if (std::find(tied.begin(), tied.end(), name) != tied.end()) continue;
    const TriangleMesh mesh = read_mesh(entry.path().string()).mesh;
    if (mesh.vertices.rows() > 4000) continue;  // for time
    expect_unchanged_by_everything({name, mesh});
  }
}

}  // namespace
}  // namespace timbre
