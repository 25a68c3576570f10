#include "timbre/analysis/geodesic/graph.h"

#include <gtest/gtest.h>

#include <cmath>

#include "timbre/analysis/core/error.h"
#include "timbre/datasets/analytic.h"

namespace timbre {
namespace {

TEST(GraphDistances, UnfoldTheDiagonalOfASquare) {
  // Two triangles of a unit square folded by 90 degrees about their common diagonal.
  TriangleMesh mesh;
  mesh.vertices.resize(4, 3);
  const double half = std::sqrt(0.5);
  mesh.vertices << -half, 0, 0, half, 0, 0, 0, half, 0, 0, 0, half;
  mesh.faces.resize(2, 3);
  mesh.faces << 0, 1, 2, 1, 0, 3;
  const Eigen::VectorXd distance = graph_distances(make_geodesic_graph(mesh), {2});
  EXPECT_NEAR(distance[3], 2.0 * half, 1e-15);
  EXPECT_NEAR(distance[0], 1.0, 1e-15);
}

TEST(GraphDistances, AreNearTheGreatCirclesOfASphere) {
  const TriangleMesh sphere = make_sphere(20);
  const Eigen::VectorXd distance = graph_distances(make_geodesic_graph(sphere), {0});
  double error = 0.0;
  for (Eigen::Index v = 1; v < distance.size(); ++v) {
    const double exact =
        std::acos(std::clamp(sphere.vertices.row(v).dot(sphere.vertices.row(0)), -1.0, 1.0));
    EXPECT_GT(distance[v], 0.99 * exact);
    error += distance[v] / exact - 1.0;
  }
  EXPECT_LT(error / static_cast<double>(distance.size()), 0.03);
}

TEST(GraphDistances, AreInfiniteOnAnotherComponent) {
  TriangleMesh mesh = make_rectangle(1, 1, 2, 2);
  mesh.vertices.conservativeResize(10, 3);
  mesh.vertices.row(9).setZero();
  EXPECT_TRUE(std::isinf(graph_distances(make_geodesic_graph(mesh), {0})[9]));
}

TEST(GraphDistances, RefuseASourceThatDoesNotExist) {
  const GeodesicGraph graph = make_geodesic_graph(make_rectangle(1, 1, 1, 1));
  try {
    (void)graph_distances(graph, {4});
    FAIL() << "no exception";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "sources: vertex 4 does not exist; the mesh has 4");
  }
}

TEST(GraphDistanceRows, AreTheSameForAnyNumberOfThreads) {
  const GeodesicGraph graph = make_geodesic_graph(make_sphere(8));
  const std::vector<std::int32_t> sources = {0, 5, 17, 100};
  const RowMatrixXf one = graph_distance_rows(graph, sources, 1);
  EXPECT_EQ(one, graph_distance_rows(graph, sources, 3));
  EXPECT_EQ(one(2, 17), 0.0F);
}

TEST(GeodesicFarthestPoints, StartAtTheCornersOfARectangle) {
  const GeodesicGraph graph = make_geodesic_graph(make_rectangle(2, 1, 20, 10));
  const std::vector<std::int32_t> points = geodesic_farthest_points(graph, 4, 0);
  EXPECT_EQ(points[0], 0);
  EXPECT_EQ(points[1], 21 * 11 - 1);
  EXPECT_EQ(geodesic_farthest_points(graph, 100000, 0).size(), 21U * 11U);
}

}  // namespace
}  // namespace timbre
