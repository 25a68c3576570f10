#include "timbre/analysis/operators/detail/intrinsic_delaunay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "timbre/analysis/operators/detail/tufted_cover.h"
#include "timbre/tests/support/mesh_shapes.h"
#include "timbre/tests/support/odd_shapes.h"

namespace timbre::detail {
namespace {

using Triangulation = IntrinsicTriangulation;

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

std::int32_t next(std::int32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }

double area(const Triangulation& t) {
  double sum = 0.0;
  for (std::size_t h = 0; h < t.length.size(); h += 3) {
    sum += t.share * triangle_area({t.length[h], t.length[h + 1], t.length[h + 2]});
  }
  return sum;
}

// Both sides of an edge agree on its length and its ends.
void expect_sound(const Triangulation& t) {
  for (std::int32_t h = 0; h < std::ssize(t.tail); ++h) {
    const std::int32_t twin = t.twin[at(h)];
    if (twin < 0) continue;
    ASSERT_NE(twin, h);
    EXPECT_EQ(t.twin[at(twin)], h);
    EXPECT_EQ(t.length[at(twin)], t.length[at(h)]);
    EXPECT_EQ(t.tail[at(h)], t.tail[at(next(twin))]);
    EXPECT_EQ(t.tail[at(twin)], t.tail[at(next(h))]);
  }
}

void expect_delaunay(const Triangulation& t) {
  const std::vector<double> cotangent = opposite_cotangents(t);
  for (std::size_t h = 0; h < t.tail.size(); ++h) {
    if (t.twin[h] < 0) continue;
    const double sum = cotangent[h] + cotangent[at(t.twin[h])];
    EXPECT_GT(sum, -1e-9 * (1.0 + std::abs(cotangent[h]))) << h;
  }
}

Surface surface_of(const TriangleMesh& mesh) { return make_surface(mesh, 1e-5); }

TEST(MakeDelaunay, FlipsTheLongDiagonalOfARhombus) {
  const TriangleMesh mesh =
      make_mesh({{-3, 0, 0}, {3, 0, 0}, {0, 1, 0}, {0, -1, 0}}, {{0, 1, 2}, {1, 0, 3}});
  Triangulation t = oriented_sheet(surface_of(mesh));
  EXPECT_EQ(make_delaunay(t), 1);
  expect_sound(t);
  expect_delaunay(t);
  // The short diagonal is 2, in units of 4.
  EXPECT_NEAR(*std::min_element(t.length.begin(), t.length.end()), 0.5, 1e-15);
}

TEST(MakeDelaunay, LeavesDelaunayMeshesAlone) {
  for (const TriangleMesh& mesh : {sphere(2), octahedron(), torus(12, 8)}) {
    Triangulation t = oriented_sheet(surface_of(mesh));
    const Triangulation before = t;
    EXPECT_EQ(make_delaunay(t), 0);
    EXPECT_EQ(t.length, before.length);
    EXPECT_EQ(t.tail, before.tail);
  }
}

TEST(MakeDelaunay, KeepsTheAreaOfAnyCover) {
  for (const TriangleMesh& mesh :
       {make_book(3, 6, true), with_cut_edges(sphere(2), 60, 1e-3), moebius_strip(8), grid(3)}) {
    Triangulation t = tufted_cover(surface_of(mesh), &mesh.vertices);
    const double before = area(t);
    make_delaunay(t);
    expect_sound(t);
    expect_delaunay(t);
    EXPECT_NEAR(area(t), before, 1e-12 * before);
  }
}

TEST(OrientedSheet, IsEmptyWhereOneSheetCannotDo) {
  EXPECT_TRUE(oriented_sheet(surface_of(make_book(3, 4))).tail.empty());
  EXPECT_TRUE(oriented_sheet(surface_of(moebius_strip(8))).tail.empty());
  EXPECT_TRUE(oriented_sheet(surface_of(make_book(2, 4))).tail.empty());  // turned unlike
  EXPECT_FALSE(oriented_sheet(surface_of(grid(3))).tail.empty());
}

// Closed and oriented whatever it covers: each halfedge has a twin that runs the other way.
TEST(TuftedCover, IsClosedAndOriented) {
  for (const TriangleMesh& mesh : {make_book(5, 4), moebius_strip(8), tetrahedron(),
                                   make_soup(SoupKind::generic, 3), make_soup(SoupKind::flat, 4)}) {
    const Surface surface = surface_of(mesh);
    const Triangulation cover = tufted_cover(surface, &mesh.vertices);
    EXPECT_EQ(cover.tail.size(), 6 * surface.faces.size());
    EXPECT_EQ(*std::min_element(cover.twin.begin(), cover.twin.end()) >= 0, true);
    expect_sound(cover);
  }
}

TEST(TuftedCover, JoinsTheSidesThatFaceEachOther) {
  // Four pages in a cross: each page's front meets the next page's back.
  const TriangleMesh mesh =
      make_mesh({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}},
                {{0, 1, 2}, {0, 1, 4}, {1, 0, 3}, {0, 1, 5}});  // turned and out of order
  const Triangulation cover = tufted_cover(surface_of(mesh), &mesh.vertices);
  std::multiset<std::set<std::int32_t>> met;
  for (std::int32_t h = 0; h < std::ssize(cover.tail); ++h) {
    const std::int32_t from = cover.tail[at(h)];
    const std::int32_t to = cover.tail[at(next(h))];
    if (from != 0 || to != 1) continue;
    const auto apex = [&](std::int32_t halfedge) { return cover.tail[at(next(next(halfedge)))]; };
    met.insert({apex(h), apex(cover.twin[at(h)])});
  }
  EXPECT_EQ(met, (std::multiset<std::set<std::int32_t>>{{2, 3}, {3, 4}, {4, 5}, {2, 5}}));
}

}  // namespace
}  // namespace timbre::detail
