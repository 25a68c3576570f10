#include "timbre/analysis/geodesic/heat.h"

#include <gtest/gtest.h>

#include <cmath>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/geodesic/exact.h"
#include "timbre/datasets/analytic.h"
#include "timbre/tests/support/shapes.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

VectorXd heat_distances(const TriangleMesh& mesh, const std::vector<std::int32_t>& sources,
                        const HeatOptions& options = {}) {
  return HeatGeodesics(mesh, options).distances(sources);
}

double mean_relative_error(const VectorXd& found, const VectorXd& truth) {
  double sum = 0.0;
  for (Index v = 0; v < found.size(); ++v) {
    if (truth[v] > 0.0) sum += std::abs(found[v] / truth[v] - 1.0);
  }
  return sum / static_cast<double>(found.size());
}

TEST(HeatGeodesics, AreWithinOnePercentOnASphere) {
  const TriangleMesh sphere = make_sphere(32);
  VectorXd truth = sphere.vertices * sphere.vertices.row(5).transpose();
  for (double& x : truth) x = std::acos(std::clamp(x, -1.0, 1.0));
  const VectorXd found = heat_distances(sphere, {5});
  EXPECT_EQ(found[5], 0.0);
  EXPECT_LT(mean_relative_error(found, truth), 0.01);
  EXPECT_LT((found - truth).cwiseAbs().maxCoeff(), 0.03);
}

TEST(HeatGeodesics, AreWithinTwoPercentOnATorusAndInAPlane) {
  for (const TriangleMesh& mesh : {make_torus(2, 0.7, 120, 42), make_rectangle(1, 1, 60, 60)}) {
    const VectorXd truth = exact_distances(make_geodesic_mesh(mesh), {0});
    EXPECT_LT(mean_relative_error(heat_distances(mesh, {0}), truth), 0.025);
  }
}

TEST(HeatGeodesics, ComeNearerWithFinerMeshes) {
  double before = 1.0;
  for (const int frequency : {8, 16, 32}) {
    const TriangleMesh mesh = make_lump(frequency);
    const VectorXd truth = exact_distances(make_geodesic_mesh(mesh), {0});
    const double error = mean_relative_error(heat_distances(mesh, {0}), truth);
    EXPECT_LT(error, before);
    before = error;
  }
  EXPECT_LT(before, 0.02);
}

TEST(HeatGeodesics, GoToTheNearestOfSeveralSources) {
  const TriangleMesh mesh = make_lump(20);
  const VectorXd truth = exact_distances(make_geodesic_mesh(mesh), {3, 900, 2000});
  const VectorXd found = heat_distances(mesh, {3, 900, 2000});
  for (const int v : {3, 900, 2000}) EXPECT_EQ(found[v], 0.0);
  EXPECT_LT((found - truth).cwiseAbs().mean(), 0.03 * truth.maxCoeff());
}

TEST(HeatGeodesics, AreInfiniteOnOtherComponents) {
  TriangleMesh mesh = make_sphere(8);
  const Index n = mesh.vertices.rows();
  const Index m = mesh.faces.rows();
  mesh.vertices.conservativeResize(2 * n + 1, 3);
  mesh.vertices.middleRows(n, n) = 1000.0 * mesh.vertices.topRows(n);
  mesh.vertices.row(2 * n).setZero();
  mesh.faces.conservativeResize(2 * m, 3);
  mesh.faces.bottomRows(m) = mesh.faces.topRows(m).array() + static_cast<std::int32_t>(n);
  HeatGeodesics heat(mesh);
  const VectorXd small = heat.distances({{0}});
  const VectorXd large = heat.distances({{static_cast<std::int32_t>(n)}});
  EXPECT_LT((1000.0 * small.head(n) - large.segment(n, n)).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_TRUE(std::isinf(small[n]));
  EXPECT_TRUE(std::isinf(large[0]));
  EXPECT_TRUE(std::isinf(small[2 * n]));
  const VectorXd unused = heat.distances({{static_cast<std::int32_t>(2 * n)}});
  EXPECT_EQ(unused[2 * n], 0.0);
  EXPECT_TRUE(std::isinf(unused[0]));
}

TEST(HeatGeodesics, DoNotDependOnUnitThreadsOrCompany) {
  TriangleMesh mesh = make_lump(10);
  HeatGeodesics heat(mesh);
  const std::vector<std::vector<std::int32_t>> sets = {{1}, {50, 60}, {7}};
  const Eigen::MatrixXd columns = heat.distances(sets, 1);
  EXPECT_EQ(columns, heat.distances(sets, 3));
  EXPECT_EQ(columns.col(1), heat.distances(sets[1]));
  for (const double unit : {1e-200, 1e200}) {
    TriangleMesh scaled = mesh;
    scaled.vertices *= unit;
    EXPECT_LT((heat_distances(scaled, {1}) / unit - columns.col(0)).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(HeatGeodesics, PassTrianglesWithoutArea) {
  TriangleMesh mesh = make_rectangle(1, 1, 20, 20);
  for (auto point : mesh.vertices.rowwise()) {
    if (point[0] > 0.49) point[0] -= 0.05;
  }
  const VectorXd truth = exact_distances(make_geodesic_mesh(mesh), {0});
  EXPECT_LT((heat_distances(mesh, {0}) - truth).cwiseAbs().maxCoeff(), 0.1);
}

// Heat falls by a constant factor with each edge, and after a thousand of them is no number.
TEST(HeatGeodesics, SayWhenNoHeatArrives) {
  const TriangleMesh strip = make_rectangle(2000, 2, 2000, 2);
  try {
    (void)heat_distances(strip, {0});
    FAIL() << "no exception";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::not_converged);
    EXPECT_NE(std::string(error.what()).find("too many edges from the source"), std::string::npos);
  }
  const VectorXd found = heat_distances(strip, {0}, {.time_factor = 100.0});
  EXPECT_NEAR(found[2000], 2000.0, 20.0);
}

TEST(HeatGeodesics, RefuseBadRequests) {
  const TriangleMesh mesh = make_rectangle(1, 1, 1, 1);
  EXPECT_THROW((void)heat_distances(mesh, {4}), Error);
  EXPECT_THROW((void)heat_distances(mesh, {0}, {.time_factor = 0.0}), Error);
}

}  // namespace
}  // namespace timbre
