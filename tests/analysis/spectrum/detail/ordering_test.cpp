#include "timbre/analysis/spectrum/detail/ordering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/operators/operator.h"
#include "timbre/analysis/spectrum/detail/symbolic.h"
#include "timbre/datasets/analytic.h"
#include "timbre/tests/support/refused_request.h"
#include "timbre/tests/support/sparse_matrices.h"

namespace timbre::detail {
namespace {

Pencil pencil_of(const SparseMatrix& K) { return make_pencil(K, SparseMatrix(K.rows(), K.cols())); }

Pencil pencil_of(const TriangleMesh& mesh) {
  const Operator op = compute_operator(mesh);
  return make_pencil(op.stiffness, op.mass);
}

bool is_permutation(std::vector<int> order, int n) {
  std::vector<int> expected(static_cast<std::size_t>(n));
  std::iota(expected.begin(), expected.end(), 0);
  std::sort(order.begin(), order.end());
  return order == expected;
}

Points random_points(Eigen::Index n) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Points points(n, 3);
  for (double& x : points.reshaped()) x = uniform(random);
  return points;
}

TEST(Adjacency, HoldsBothDirectionsAscendingWithoutTheDiagonal) {
  const Graph graph =
      adjacency(pencil_of(from_lower(4, {{0, 0, 1.0}, {2, 0, 1.0}, {3, 0, 1.0}, {3, 2, 1.0}})));
  EXPECT_EQ(graph.start, (std::vector<int>{0, 2, 2, 4, 6}));
  EXPECT_EQ(graph.neighbours, (std::vector<int>{2, 3, 0, 3, 0, 2}));
}

TEST(ComputeOrdering, IsAPermutationForEveryPatternAndMethod) {
  for (const NamedMatrix& named : matrices_of_many_patterns()) {
    const Graph graph = adjacency(pencil_of(named.matrix));
    const Points points = random_points(graph.size());
    for (const OrderingMethod method :
         {OrderingMethod::automatic, OrderingMethod::geometric, OrderingMethod::metis,
          OrderingMethod::minimum_degree, OrderingMethod::natural}) {
      if (method == OrderingMethod::metis && !has_metis()) continue;
      const std::vector<int> order = compute_ordering(graph, &points, method);
      EXPECT_TRUE(is_permutation(order, graph.size())) << named.name;
      EXPECT_EQ(order, compute_ordering(graph, &points, method)) << named.name;
    }
  }
}

TEST(ComputeOrdering, TakesPointsThatLieOnEachOtherOrOnALine) {
  const Graph graph = adjacency(pencil_of(random_sparse(300, 5.0, 2)));
  Points points = Points::Zero(300, 3);
  EXPECT_TRUE(is_permutation(geometric_dissection(graph, points), 300));
  points.col(1).setLinSpaced(0.0, 1.0);
  EXPECT_TRUE(is_permutation(geometric_dissection(graph, points), 300));
  points.col(1).setConstant(1e300);
  points(17, 1) = -1e300;
  EXPECT_TRUE(is_permutation(geometric_dissection(graph, points), 300));
}

// On surfaces both dissections fill about as little; the order of the vertices fills far more.
TEST(ComputeOrdering, DissectionFillsLittleOnSurfaces) {
  for (const TriangleMesh& mesh :
       {make_sphere(40), make_ellipsoid(1.0, 0.5, 4.0, 40), make_torus(3.0, 1.0, 200, 80)}) {
    const Pencil pencil = pencil_of(mesh);
    const Graph graph = adjacency(pencil);
    const auto entries = [&](OrderingMethod method) {
      return static_cast<double>(
          analyse(pencil, compute_ordering(graph, &mesh.vertices, method)).entries);
    };
    const double geometric = entries(OrderingMethod::geometric);
    EXPECT_LT(geometric, 0.5 * entries(OrderingMethod::natural));
    if (!has_metis()) continue;
    EXPECT_LT(geometric, 1.6 * entries(OrderingMethod::metis));
  }
}

TEST(ComputeOrdering, RefusesPositionsThatDoNotFit) {
  const Graph graph = adjacency(pencil_of(random_sparse(10, 3.0, 1)));
  Points points = random_points(9);
  const auto order = [&](const Points* p) {
    return [&graph, p] { (void)compute_ordering(graph, p, OrderingMethod::geometric); };
  };
  EXPECT_EQ(refused_request(order(nullptr)),
            "ordering: 'geometric' needs positions; choose 'metis' or 'automatic'");
  EXPECT_EQ(refused_request(order(&points)),
            "ordering: 9 positions for 10 unknowns; one for each is needed");
  points = random_points(10);
  points(3, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refused_request(order(&points)), "ordering: a position is not finite");
}

}  // namespace
}  // namespace timbre::detail
