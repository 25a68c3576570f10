#include "timbre/analysis/geodesic/exact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <utility>

#include "timbre/analysis/core/error.h"
#include "timbre/datasets/analytic.h"
#include "timbre/tests/support/mesh_shapes.h"
#include "timbre/tests/support/shapes.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kPi = std::numbers::pi;

VectorXd distances(const TriangleMesh& mesh, std::int32_t source) {
  return exact_distances(make_geodesic_mesh(mesh), {source});
}

// Each vertex to each: n x n.
Eigen::MatrixXd all_distances(const TriangleMesh& mesh) {
  const GeodesicMesh prepared = make_geodesic_mesh(mesh);
  ExactGeodesics geodesics(prepared);
  Eigen::MatrixXd all(mesh.vertices.rows(), mesh.vertices.rows());
  for (std::int32_t v = 0; v < all.cols(); ++v) all.col(v) = geodesics.distances({{v}});
  return all;
}

double largest_difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  double most = 0.0;
  for (Index i = 0; i < a.rows(); ++i) {
    for (Index j = 0; j < a.cols(); ++j) {
      if (std::isinf(a(i, j)) && std::isinf(b(i, j))) continue;
      most = std::max(most, std::abs(a(i, j) - b(i, j)));
    }
  }
  return most;
}

VectorXd straight_distances(const TriangleMesh& mesh, std::int32_t source) {
  return (mesh.vertices.rowwise() - mesh.vertices.row(source)).rowwise().norm();
}

// A unit square whose inner vertices are moved at random, by less than would fold it.
TriangleMesh uneven_square(int n) {
  TriangleMesh mesh = make_rectangle(1, 1, n, n);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shift(-0.24 / n, 0.24 / n);
  for (auto point : mesh.vertices.rowwise()) {
    for (int k = 0; k < 2; ++k) {
      const double by = shift(random);
      if (point[k] > 1e-9 && point[k] < 1.0 - 1e-9) point[k] += by;
    }
  }
  return mesh;
}

// Only the faces that `keep` likes, judged by their centre.
template <typename Keep>
TriangleMesh part_of(const TriangleMesh& mesh, const Keep& keep) {
  TriangleMesh result = mesh;
  Index count = 0;
  for (const auto& face : mesh.faces.rowwise()) {
    const Eigen::RowVector3d centre =
        (mesh.vertices.row(face[0]) + mesh.vertices.row(face[1]) + mesh.vertices.row(face[2])) /
        3.0;
    if (keep(centre)) result.faces.row(count++) = face;
  }
  result.faces.conservativeResize(count, 3);
  return result;
}

// Each triangle in four, flat: the same surface with more vertices after the old ones.
TriangleMesh subdivided(const TriangleMesh& mesh) {
  TriangleMesh result;
  std::map<std::pair<int, int>, std::int32_t> middles;
  std::vector<Eigen::RowVector3d> added;
  const auto middle = [&](int a, int b) {
    const auto [found, is_new] = middles.try_emplace(
        std::minmax(a, b), static_cast<std::int32_t>(mesh.vertices.rows() + std::ssize(added)));
    if (is_new) added.emplace_back(0.5 * (mesh.vertices.row(a) + mesh.vertices.row(b)));
    return found->second;
  };
  result.faces.resize(4 * mesh.faces.rows(), 3);
  for (Index f = 0; f < mesh.faces.rows(); ++f) {
    const auto [a, b, c] = std::array{mesh.faces(f, 0), mesh.faces(f, 1), mesh.faces(f, 2)};
    const std::int32_t ab = middle(a, b);
    const std::int32_t bc = middle(b, c);
    const std::int32_t ca = middle(c, a);
    result.faces.middleRows(4 * f, 4) << a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca;
  }
  result.vertices.resize(mesh.vertices.rows() + std::ssize(added), 3);
  result.vertices.topRows(mesh.vertices.rows()) = mesh.vertices;
  for (std::size_t i = 0; i < added.size(); ++i) {
    result.vertices.row(mesh.vertices.rows() + static_cast<Index>(i)) = added[i];
  }
  return result;
}

TEST(ExactDistances, AreStraightInAPlane) {
  for (const TriangleMesh& mesh : {make_rectangle(1, 1, 40, 40), uneven_square(40)}) {
    for (const std::int32_t source : {0, 840, 77}) {
      EXPECT_LT((distances(mesh, source) - straight_distances(mesh, source)).cwiseAbs().maxCoeff(),
                1e-13);
    }
  }
}

TEST(ExactDistances, AreGreatCirclesOfAFineSphere) {
  const TriangleMesh sphere = make_sphere(32);
  const VectorXd found = distances(sphere, 5);
  double sum = 0.0;
  for (Index v = 0; v < found.size(); ++v) {
    if (v == 5) continue;
    const double arc =
        std::acos(std::clamp(sphere.vertices.row(v).dot(sphere.vertices.row(5)), -1.0, 1.0));
    sum += std::abs(found[v] / arc - 1.0);
  }
  EXPECT_LT(sum / static_cast<double>(found.size()), 2e-4);
}

// A prism of `sides` flat sides, open at both ends: rolled up from a strip.
TEST(ExactDistances, UnrollACylinder) {
  constexpr int kSides = 24;
  constexpr int kRings = 30;
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::int32_t, 3>> faces;
  for (std::int32_t j = 0; j <= kRings; ++j) {
    for (std::int32_t i = 0; i < kSides; ++i) {
      const double angle = 2.0 * kPi * i / kSides;
      vertices.push_back({std::cos(angle), std::sin(angle), 0.2 * j});
      const auto at = [](std::int32_t p, std::int32_t q) { return q * kSides + p % kSides; };
      if (j == kRings) continue;
      faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  constexpr std::int32_t kSource = 7 * kSides + 3;
  const VectorXd found = distances(make_mesh(vertices, faces), kSource);
  const double width = 2.0 * std::sin(kPi / kSides);
  for (std::int32_t v = 0; v < found.size(); ++v) {
    const int steps = std::abs(v % kSides - 3);
    const double round = width * std::min(steps, kSides - steps);
    EXPECT_NEAR(found[v], std::hypot(round, 0.2 * (v / kSides - 7)), 1e-12);
  }
}

// A pyramid or a crown: `sides` equal triangles of apex angle `angle` round vertex 0, cut into
// rings; the ridges go up and down by turns where the angles are too many for a cone.
TriangleMesh make_fan(int sides, int rings, double elevation, double other_elevation) {
  std::vector<std::array<double, 3>> vertices = {{0, 0, 0}};
  std::vector<std::array<std::int32_t, 3>> faces;
  for (int j = 1; j <= rings; ++j) {
    for (int i = 0; i < sides; ++i) {
      const double up = i % 2 == 0 ? elevation : other_elevation;
      const double turn = 2.0 * kPi * i / sides;
      const double r = static_cast<double>(j) / rings;
      vertices.push_back(
          {r * std::cos(up) * std::cos(turn), r * std::cos(up) * std::sin(turn), r * std::sin(up)});
      const auto at = [sides](int p, int q) {
        return q == 0 ? 0 : 1 + (q - 1) * sides + p % sides;
      };
      faces.push_back({at(i, j - 1), at(i, j), at(i + 1, j)});
      if (j > 1) faces.push_back({at(i, j - 1), at(i + 1, j), at(i + 1, j - 1)});
    }
  }
  return make_mesh(vertices, faces);
}

void expect_distances_of_fan(const TriangleMesh& fan, int sides, int rings) {
  const double step = std::acos(fan.vertices.row(1).dot(fan.vertices.row(2)) * rings * rings);
  const std::int32_t source = 1 + 3 * sides;  // ring 4, ridge 0
  const VectorXd found = distances(fan, source);
  EXPECT_NEAR(found[0], 4.0 / rings, 1e-13);
  for (std::int32_t v = 1; v < found.size(); ++v) {
    const int ridge = (v - 1) % sides;
    const double r = 1.0 / rings * ((v - 1) / sides + 1);
    const double s = 4.0 / rings;
    const double angle = step * std::min(ridge, sides - ridge);
    const double expected =
        angle < kPi ? std::sqrt(r * r + s * s - 2.0 * r * s * std::cos(angle)) : r + s;
    EXPECT_NEAR(found[v], expected, 1e-12) << "ridge " << ridge << " radius " << r;
  }
}

TEST(ExactDistances, UnrollACone) { expect_distances_of_fan(make_fan(17, 12, 0.9, 0.9), 17, 12); }

TEST(ExactDistances, BendAtASaddle) {
  expect_distances_of_fan(make_fan(16, 12, 0.4, -0.4), 16, 12);
}

// Six faces of n x n squares, the vertices on edges shared.
TriangleMesh cube(int n) {
  std::map<std::array<int, 3>, std::int32_t> numbers;
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::int32_t, 3>> faces;
  const auto vertex = [&](std::array<int, 3> p) {
    const auto [found, is_new] = numbers.try_emplace(p, static_cast<std::int32_t>(vertices.size()));
    if (is_new) vertices.push_back({double(p[0]) / n, double(p[1]) / n, double(p[2]) / n});
    return found->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const int level : {0, n}) {
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const auto at = [&](int p, int q) {
            std::array<int, 3> point{};
            point[axis] = level;
            point[(axis + 1) % 3] = p;
            point[(axis + 2) % 3] = q;
            return vertex(point);
          };
          faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
          faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
      }
    }
  }
  return make_mesh(vertices, faces);
}

// From a corner, each far face is reached over one of the two near faces beside it.
double distance_from_corner(double x, double y, double z) {
  if (x == 0.0 || y == 0.0 || z == 0.0) return std::hypot(x, y, z);
  if (y == 1.0) std::swap(x, y);
  if (z == 1.0) std::swap(x, z);
  return std::min(std::hypot(1.0 + y, z), std::hypot(1.0 + z, y));
}

TEST(ExactDistances, GoRoundTheEdgesOfACube) {
  const TriangleMesh mesh = cube(8);
  const VectorXd found = distances(mesh, 0);
  ASSERT_EQ(mesh.vertices.row(0).norm(), 0.0);
  for (Index v = 0; v < found.size(); ++v) {
    double expected =
        distance_from_corner(mesh.vertices(v, 0), mesh.vertices(v, 1), mesh.vertices(v, 2));
    // A vertex of two far faces has both ways.
    for (const auto& [a, b] : {std::pair{0, 1}, {1, 2}, {2, 0}}) {
      if (mesh.vertices(v, a) != 1.0 || mesh.vertices(v, b) != 1.0) continue;
      expected = std::min(std::hypot(2.0, mesh.vertices(v, 3 - a - b)),
                          std::hypot(1.0, 1.0 + mesh.vertices(v, 3 - a - b)));
    }
    EXPECT_NEAR(found[v], expected, 1e-13) << mesh.vertices.row(v);
  }
}

TEST(ExactDistances, TurnRoundTheCornerOfAnL) {
  const TriangleMesh mesh =
      part_of(make_rectangle(1, 1, 30, 30), [](const auto& p) { return p[0] < 0.5 || p[1] < 0.5; });
  const Eigen::RowVector3d corner(0.5, 0.5, 0.0);
  const Eigen::RowVector3d source(0.1, 0.9, 0.0);
  const VectorXd found = distances(mesh, 31 * 27 + 3);
  for (Index v = 0; v < found.size(); ++v) {
    if (std::isinf(found[v])) continue;
    const Eigen::RowVector3d point = mesh.vertices.row(v);
    const bool hidden = point[0] > 0.5 && point[0] + point[1] > 1.0 + 1e-9;
    const double expected =
        hidden ? (source - corner).norm() + (corner - point).norm() : (source - point).norm();
    EXPECT_NEAR(found[v], expected, 1e-13) << point;
  }
}

TEST(ExactDistances, GoRoundAHole) {
  const TriangleMesh mesh = part_of(make_rectangle(1, 1, 30, 30), [](const auto& p) {
    return std::abs(p[0] - 0.5) > 0.2 || std::abs(p[1] - 0.5) > 0.2;
  });
  constexpr std::int32_t kSource = 31 * 15;  // the middle of the left edge
  const VectorXd found = distances(mesh, kSource);
  for (Index v = 0; v < found.size(); ++v) {
    const double x = mesh.vertices(v, 0);
    const double y = std::abs(mesh.vertices(v, 1) - 0.5);
    if (std::isinf(found[v])) continue;
    double expected = std::hypot(x, y);
    const double slope = 0.2 / 0.3;  // past the hole's near corners
    if (x > 0.3 && y < slope * x - 1e-12) {
      const double near_corner = std::hypot(0.3, 0.2);
      expected = y >= 0.2 - 1e-12 ? near_corner + std::hypot(x - 0.3, y - 0.2)
                                  : near_corner + 0.4 + std::hypot(x - 0.7, 0.2 - y);
    }
    EXPECT_NEAR(found[v], expected, 1e-13) << mesh.vertices.row(v);
  }
}

TEST(ExactDistances, FollowTheCirclesOfATorusThatAreGeodesics) {
  constexpr int kRound = 300;
  constexpr int kThrough = 120;
  const TriangleMesh mesh = torus(kRound, kThrough);  // radii 2 and 1
  const VectorXd found = distances(mesh, 0);          // on the outer equator
  // Half way round a meridian, and the equator up to where shorter ways appear, at an arc of
  // pi sqrt(3).
  for (int j = 1; j <= kThrough / 2; ++j) {
    EXPECT_NEAR(found[j] / (2.0 * kPi * j / kThrough), 1.0, 1e-3);
  }
  for (int i = 1; 3.0 * 2.0 * kPi * i / kRound < 0.95 * kPi * std::sqrt(3.0); ++i) {
    EXPECT_NEAR(found[i * kThrough] / (3.0 * 2.0 * kPi * i / kRound), 1.0, 1e-3);
  }
}

TEST(ExactDistances, AreSymmetricShortAndTheSameForAnyNumbering) {
  const TriangleMesh mesh = make_lump(5);
  const Eigen::MatrixXd all = all_distances(mesh);
  EXPECT_LT((all - all.transpose()).cwiseAbs().maxCoeff(), 1e-12);
  const GeodesicGraph graph = make_geodesic_graph(mesh);
  for (std::int32_t v = 0; v < all.cols(); ++v) {
    EXPECT_LT((all.col(v) - graph_distances(graph, {v})).maxCoeff(), 1e-12);
    EXPECT_GT((all.col(v) - straight_distances(mesh, v)).minCoeff(), -1e-12);
  }
  const std::vector<std::int32_t> order = random_order(mesh.vertices.rows(), 3);
  const Eigen::MatrixXd again = all_distances(renumbered(mesh, order));
  double most = 0.0;
  for (Index i = 0; i < all.rows(); ++i) {
    for (Index j = 0; j < all.cols(); ++j) {
      most = std::max(most, std::abs(all(i, j) - again(order[static_cast<std::size_t>(i)],
                                                       order[static_cast<std::size_t>(j)])));
    }
  }
  EXPECT_LT(most, 1e-12);
}

TEST(ExactDistances, DoNotChangeWhenTheSurfaceIsCutFiner) {
  const TriangleMesh mesh = make_lump(3);
  const Index n = mesh.vertices.rows();
  const Eigen::MatrixXd coarse = all_distances(mesh);
  const Eigen::MatrixXd fine = all_distances(subdivided(mesh));
  EXPECT_LT((coarse - fine.topLeftCorner(n, n)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(ExactDistances, GoOnIntoEachSheetOfAnEdge) {
  // Three unit squares on the edge from (0, 0, 0) to (0, 0, 1), each a grid.
  constexpr int kCells = 6;
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::int32_t, 3>> faces;
  const auto at = [](int sheet, int i, int j) {
    return i == 0 ? j : (kCells + 1) * (1 + sheet * kCells + i - 1) + j;
  };
  for (int j = 0; j <= kCells; ++j) vertices.push_back({0, 0, double(j) / kCells});
  for (int sheet = 0; sheet < 3; ++sheet) {
    const double angle = 0.3 + 1.9 * sheet;
    for (int i = 1; i <= kCells; ++i) {
      const double r = double(i) / kCells;
      for (int j = 0; j <= kCells; ++j) {
        vertices.push_back({r * std::cos(angle), r * std::sin(angle), double(j) / kCells});
        if (j == kCells) continue;
        faces.push_back({at(sheet, i - 1, j), at(sheet, i, j), at(sheet, i, j + 1)});
        faces.push_back({at(sheet, i - 1, j), at(sheet, i, j + 1), at(sheet, i - 1, j + 1)});
      }
    }
  }
  const VectorXd found = distances(make_mesh(vertices, faces), at(0, 4, 1));
  for (int sheet = 0; sheet < 3; ++sheet) {
    for (int i = 0; i <= kCells; ++i) {
      for (int j = 0; j <= kCells; ++j) {
        const int across = sheet == 0 ? 4 - i : 4 + i;
        EXPECT_NEAR(found[at(sheet, i, j)], std::hypot(across, j - 1) / kCells, 1e-13);
      }
    }
  }
}

TEST(ExactDistances, CrossTheEdgeThatTwoCubesShare) {
  const TriangleMesh one = cube(4);
  const Index n = one.vertices.rows();
  TriangleMesh two;
  two.vertices.resize(2 * n, 3);
  two.vertices << one.vertices, -one.vertices;
  two.vertices.col(2).tail(n) *= -1.0;  // turned by 180 degrees about the z axis
  two.faces.resize(2 * one.faces.rows(), 3);
  two.faces << one.faces, one.faces.array() + static_cast<int>(n);
  for (std::int32_t& corner : two.faces.reshaped()) {
    if (corner < n || two.vertices(corner, 0) != 0.0 || two.vertices(corner, 1) != 0.0) continue;
    for (Index v = 0; v < n; ++v) {
      if (two.vertices.row(v) == two.vertices.row(corner)) corner = static_cast<std::int32_t>(v);
    }
  }
  const auto find = [&](Index from, double x, double y, double z) {
    for (Index v = from; v < 2 * n; ++v) {
      if (two.vertices.row(v) == Eigen::RowVector3d(x, y, z)) return static_cast<std::int32_t>(v);
    }
    return -1;
  };
  const VectorXd found = distances(two, find(0, 0.5, 0, 0.25));
  EXPECT_NEAR(found[find(n, -0.25, 0, 0.75)], std::hypot(0.75, 0.5), 1e-13);
  EXPECT_NEAR(found[find(n, 0, -0.75, 0.5)], std::hypot(1.25, 0.25), 1e-13);
  EXPECT_NEAR(found[find(0, 0, 0.25, 0.25)], 0.75, 1e-13);
}

TEST(ExactDistances, GoThroughAVertexWhereSheetsOnlyTouch) {
  // Two tetrahedra on one corner.
  TriangleMesh mesh = tetrahedron();
  mesh.vertices.conservativeResize(7, 3);
  mesh.vertices.bottomRows(3) = -mesh.vertices.middleRows(1, 3);
  mesh.faces.conservativeResize(8, 3);
  mesh.faces.bottomRows(4) << 0, 4, 5, 0, 5, 6, 0, 6, 4, 4, 6, 5;
  const VectorXd found = distances(mesh, 1);
  for (const int v : {4, 5, 6}) EXPECT_NEAR(found[v], 2.0, 1e-15);
}

TEST(ExactDistances, PassTrianglesWithoutArea) {
  // A grid with a row of collapsed cells in its middle: twice the same vertices, and copies.
  TriangleMesh mesh = make_rectangle(1, 1, 8, 8);
  for (auto point : mesh.vertices.rowwise()) {
    if (point[0] > 0.45) point[0] -= 0.125;
  }
  const Index m = mesh.faces.rows();
  mesh.faces.conservativeResize(2 * m + 2, 3);
  mesh.faces.middleRows(m, m) = mesh.faces.topRows(m).rowwise().reverse().eval();
  mesh.faces.bottomRows(2) << 3, 3, 4, 5, 5, 5;
  for (const std::int32_t source : {0, 40, 44, 80}) {
    EXPECT_LT((distances(mesh, source) - straight_distances(mesh, source)).cwiseAbs().maxCoeff(),
              1e-13);
  }
}

TEST(ExactDistances, PassNeedlesAndCaps) {
  TriangleMesh mesh = make_rectangle(1, 1, 12, 12);
  for (auto point : mesh.vertices.rowwise()) point[0] = std::pow(point[0], 9.0);
  for (const std::int32_t source : {0, 84, 100}) {
    EXPECT_LT((distances(mesh, source) - straight_distances(mesh, source)).cwiseAbs().maxCoeff(),
              1e-12);
  }
}

TEST(ExactDistances, AreInfiniteWhereNothingLeads) {
  TriangleMesh mesh = make_rectangle(1, 1, 2, 2);
  mesh.vertices.conservativeResize(10, 3);
  mesh.vertices.row(9) << 0.5, 0.5, 0.0;
  EXPECT_TRUE(std::isinf(distances(mesh, 0)[9]));
  const VectorXd from_unused = distances(mesh, 9);
  EXPECT_EQ(from_unused[9], 0.0);
  EXPECT_EQ((from_unused.array() < 1e300).count(), 1);
  EXPECT_EQ(exact_distances(make_geodesic_mesh({}), {}).size(), 0);
}

TEST(ExactDistances, DoNotDependOnUnitOrOrigin) {
  const TriangleMesh mesh = make_lump(4);
  const VectorXd plain = distances(mesh, 3);
  for (const double unit : {1e-300, 1e-150, 1e150, 1e300}) {
    TriangleMesh scaled = mesh;
    scaled.vertices *= unit;
    EXPECT_LT((distances(scaled, 3) / unit - plain).cwiseAbs().maxCoeff(), 1e-12) << unit;
  }
  TriangleMesh far = mesh;
  far.vertices.array() += 1e6;
  EXPECT_LT((distances(far, 3) - plain).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(ExactDistances, OfSeveralSourcesAreTheLeast) {
  const GeodesicMesh mesh = make_geodesic_mesh(make_lump(6));
  const VectorXd both = exact_distances(mesh, {3, 200, 3});
  const VectorXd least = exact_distances(mesh, {3}).cwiseMin(exact_distances(mesh, {200}));
  EXPECT_LT((both - least).cwiseAbs().maxCoeff(), 1e-12);
}

// Triangles thrown between few points of a small lattice: every edge that can go wrong.
void expect_properties_of_random_triangles(unsigned seed) {
  std::mt19937 random(seed);
  const auto below = [&random](int n) {
    return static_cast<int>(random() % static_cast<unsigned>(n));
  };
  TriangleMesh mesh;
  const int n = 4 + below(9);
  mesh.vertices.resize(n, 3);
  for (double& x : mesh.vertices.reshaped()) x = below(4);
  mesh.faces.resize(3 + below(30), 3);
  for (auto face : mesh.faces.rowwise()) {
    do {
      for (std::int32_t& corner : face) corner = below(n);
    } while (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]);
  }
  const Eigen::MatrixXd all = all_distances(mesh);
  EXPECT_LT(largest_difference(all, all.transpose()), 1e-12);
  const GeodesicGraph graph = make_geodesic_graph(mesh);
  for (std::int32_t v = 0; v < n; ++v) {
    const VectorXd bound = graph_distances(graph, {v});
    for (std::int32_t w = 0; w < n; ++w) {
      EXPECT_EQ(std::isinf(all(w, v)), std::isinf(bound[w]));
      if (std::isinf(bound[w])) continue;
      EXPECT_LT(all(w, v), bound[w] + 1e-12);
    }
  }
  const Eigen::MatrixXd fine = all_distances(subdivided(mesh)).topLeftCorner(n, n);
  EXPECT_LT(largest_difference(all, fine), 1e-12);
}

TEST(ExactDistances, KeepTheirPropertiesOnAnyTriangles) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    expect_properties_of_random_triangles(seed);
  }
}

TEST(ExactGeodesics, FindTargetsAsAFullRunDoes) {
  const GeodesicMesh mesh = make_geodesic_mesh(make_lump(10));
  ExactGeodesics geodesics(mesh);
  std::mt19937 random(5);
  const auto any = [&] { return static_cast<std::int32_t>(random() % 1002U); };
  for (int i = 0; i < 60; ++i) {
    const std::vector<std::int32_t> sources = {any(), any()};
    std::vector<std::int32_t> targets;
    for (int t = 0; t < 1 + i % 5; ++t) targets.push_back(any());
    if (i % 10 == 0) {
      while (targets.size() < 100) targets.push_back(any());
    }
    const VectorXd all = exact_distances(mesh, sources);
    const std::vector<double> found = geodesics.distances_to(sources, targets);
    const VectorXd some = geodesics.distances(sources, {.targets = targets});
    for (std::size_t t = 0; t < targets.size(); ++t) {
      EXPECT_NEAR(found[t], all[targets[t]], 1e-12);
      EXPECT_EQ(found[t], some[targets[t]]);
    }
  }
}

TEST(ExactGeodesics, StopAtTheLimit) {
  const GeodesicMesh mesh = make_geodesic_mesh(make_lump(10));
  ExactGeodesics geodesics(mesh);
  const VectorXd all = exact_distances(mesh, {17});
  const VectorXd near = geodesics.distances({{17}}, {.limit = 0.7});
  for (std::int32_t v = 0; v < all.size(); ++v) {
    if (all[v] <= 0.7) {
      EXPECT_NEAR(near[v], all[v], 1e-12);
      EXPECT_NEAR(geodesics.distances_to({{17}}, {{v}}, 0.7)[0], all[v], 1e-12);
    } else {
      EXPECT_TRUE(std::isinf(near[v]));
      EXPECT_TRUE(std::isinf(geodesics.distances_to({{17}}, {{v}}, 0.7)[0]));
    }
  }
}

TEST(ExactGeodesics, ForgetThePreviousRun) {
  const GeodesicMesh mesh = make_geodesic_mesh(make_lump(6));
  ExactGeodesics geodesics(mesh);
  const VectorXd first = geodesics.distances({{1}});
  (void)geodesics.distances_to({{200}}, {{7, 9}});
  (void)geodesics.distances({{40}}, {.limit = 0.2});
  EXPECT_EQ(geodesics.distances({{1}}), first);
}

TEST(ExactGeodesics, RefuseWhatDoesNotExist) {
  const GeodesicMesh mesh = make_geodesic_mesh(make_rectangle(1, 1, 1, 1));
  try {
    (void)exact_distances(mesh, {4});
    FAIL() << "no exception";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_request);
    EXPECT_STREQ(error.what(), "sources: vertex 4 does not exist; the mesh has 4");
  }
  EXPECT_THROW((void)exact_distances(mesh, {0}, {.targets = {-1}}), Error);
  EXPECT_THROW((void)exact_distances(mesh, {0}, {.limit = std::nan("")}), Error);
}

}  // namespace
}  // namespace timbre
