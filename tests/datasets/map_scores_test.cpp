#include "timbre/datasets/map_scores.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "timbre/analysis/core/error.h"
#include "timbre/datasets/analytic.h"
#include "timbre/datasets/random.h"

namespace timbre {
namespace {

using Vertices = std::vector<std::int32_t>;

// 41 x 21 points of the rectangle [0, 2] x [0, 1]; neighbours lie 0.05 apart, which is an
// error of 100 * 0.05 / sqrt(2).
constexpr std::int32_t kColumns = 41;
constexpr std::int32_t kPoints = 861;
const double kStep = 5.0 / std::numbers::sqrt2;

TriangleMesh rectangle() { return make_rectangle(2.0, 1.0, 40, 20); }

const ErrorScale& scale() {
  static const ErrorScale made(rectangle(), GeodesicKind::exact);
  return made;
}

Vertices identity() {
  Vertices map(kPoints);
  for (std::int32_t v = 0; v < kPoints; ++v) map[static_cast<std::size_t>(v)] = v;
  return map;
}

Vertices random_vertices(std::uint64_t seed) {
  Random random("vertices", {seed});
  Vertices list(500);
  for (std::int32_t& v : list) v = static_cast<std::int32_t>(random.uniform(0.0, kPoints));
  return list;
}

Truth truth_of(Vertices source, Vertices target, bool partial = false) {
  return {std::move(source), std::move(target), partial};
}

std::string refusal(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(ErrorScale, MeasuresStraightLinesOnAPlane) {
  const Vertices from = random_vertices(1);
  const Vertices to = random_vertices(2);
  const std::vector<double> errors = scale().between(from, to, 1);
  const TriangleMesh mesh = rectangle();
  for (std::size_t i = 0; i < from.size(); ++i) {
    const double length = (mesh.vertices.row(from[i]) - mesh.vertices.row(to[i])).norm();
    EXPECT_NEAR(errors[i], 100.0 * length / std::numbers::sqrt2, 1e-9);
  }
}

TEST(ErrorScale, IsTheSameForAnyNumberOfThreads) {
  for (const GeodesicKind kind : {GeodesicKind::exact, GeodesicKind::graph}) {
    const ErrorScale measured(rectangle(), kind);
    const Vertices from = random_vertices(1);
    const Vertices to = random_vertices(2);
    EXPECT_EQ(measured.between(from, to, 1), measured.between(from, to, 2));
  }
}

TEST(ErrorScale, OfAGraphIsNeverTheShorter) {
  const TriangleMesh mesh = make_ellipsoid(1.0, 0.8, 0.6, 9);
  const ErrorScale exact(mesh, GeodesicKind::exact);
  const ErrorScale graph(mesh, GeodesicKind::graph);
  Vertices from, to;
  for (std::int32_t v = 0; v < 800; ++v) {
    from.push_back(v);
    to.push_back(v / 100);
  }
  const std::vector<double> straight = exact.between(from, to, 1);
  const std::vector<double> along = graph.between(from, to, 1);
  for (std::size_t i = 0; i < from.size(); ++i) {
    EXPECT_GE(along[i], straight[i] - 1e-9);
    EXPECT_LE(along[i], 1.1 * straight[i] + 1e-9);
  }
}

TEST(ErrorScale, DoesNotDependOnTheUnit) {
  const Vertices from = random_vertices(1);
  const Vertices to = random_vertices(2);
  const std::vector<double> wanted = scale().between(from, to, 1);
  for (const double unit : {1e-6, 1e6}) {
    TriangleMesh mesh = rectangle();
    mesh.vertices *= unit;
    const std::vector<double> found = ErrorScale(mesh, GeodesicKind::exact).between(from, to, 1);
    for (std::size_t i = 0; i < from.size(); ++i) EXPECT_NEAR(found[i], wanted[i], 1e-6);
  }
}

TEST(ErrorScale, IsAHundredBetweenComponents) {
  const TriangleMesh one = make_rectangle(1.0, 1.0, 2, 2);
  TriangleMesh two;
  two.vertices.resize(19, 3);
  two.vertices << one.vertices, one.vertices, Eigen::RowVector3d(0.5, 0.5, 0.0);
  two.faces.resize(16, 3);
  two.faces << one.faces, (one.faces.array() + 9).matrix();
  for (const GeodesicKind kind : {GeodesicKind::exact, GeodesicKind::graph}) {
    const ErrorScale measured(two, kind);
    const Vertices from = {0, 9, 18, 18, 0};
    const Vertices to = {9, 17, 0, 18, 18};
    const std::vector<double> errors = measured.between(from, to, 1);
    EXPECT_EQ(errors[0], 100.0);
    EXPECT_NEAR(errors[1], 100.0, 5.0);  // the diagonal of one of the two squares
    EXPECT_EQ(errors[2], 100.0);
    EXPECT_EQ(errors[3], 0.0);  // a vertex of no triangle is where it is
    EXPECT_EQ(errors[4], 100.0);
  }
}

TEST(ErrorScale, RefusesWhatCannotBeMeasured) {
  TriangleMesh flat = rectangle();
  flat.vertices.col(1).setZero();
  EXPECT_EQ(refusal([&] { (void)ErrorScale(flat, GeodesicKind::exact); }),
            "area: is 0 or beyond a double's range");
  const Vertices one = {0};
  for (const std::int32_t v : {-1, kPoints}) {
    const Vertices wrong = {v};
    const std::string line =
        "distances: " + std::to_string(v) + " is no vertex; the mesh has 861, from 0";
    EXPECT_EQ(refusal([&] { (void)scale().between(one, wrong, 1); }), line);
    EXPECT_EQ(refusal([&] { (void)scale().between(wrong, one, 1); }), line);
  }
  EXPECT_EQ(refusal([&] { (void)scale().between(one, Vertices{}, 1); }),
            "distances: want as many ends as starts, not 0 and 1");
  EXPECT_TRUE(scale().between({}, {}, 1).empty());
}

TEST(ScoreMap, AgreesWithTheCaseWorkedByHand) {
  Vertices map = identity();
  map[1] = 2;
  map[2] = 2 + 2 * kColumns;
  map[3] = -1;
  const MapScore score = score_map(map, truth_of({0, 1, 2, 3}, {0, 1, 2, 3}), scale(), 1);
  EXPECT_EQ(score.rows, 4);
  ASSERT_EQ(score.errors.size(), 3U);
  EXPECT_EQ(score.errors[0], 0.0);
  EXPECT_NEAR(score.errors[1], kStep, 1e-9);
  EXPECT_NEAR(score.errors[2], 2.0 * kStep, 1e-9);
  EXPECT_NEAR(score.mean_error, kStep, 1e-9);
  EXPECT_EQ(score.below5, 2.0 / 3.0);
  EXPECT_EQ(score.matched, 0.75);
  EXPECT_FALSE(score.found);
  EXPECT_EQ(score.share_below(-1.0), 0.0);
  EXPECT_EQ(score.share_below(0.0), 0.25);
  EXPECT_EQ(score.share_below(kStep + 1e-6), 0.5);
  EXPECT_EQ(score.share_below(1e300), 0.75);
}

TEST(ScoreMap, CountsRepeatedRowsAsOftenAsTheyOccur) {
  const MapScore score = score_map(identity(), truth_of({0, 0, 0, 5}, {0, 0, 1, 5}), scale(), 1);
  EXPECT_EQ(score.rows, 4);
  EXPECT_NEAR(score.mean_error, kStep / 4.0, 1e-9);
  EXPECT_TRUE(score.found);
  EXPECT_EQ(score.below5, 1.0);
}

TEST(ScoreMap, FindsAPartByNineTenthsAndAWholeByAll) {
  const Vertices rows = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  Vertices map = identity();
  for (const std::int32_t unanswered : {0, 1, 2}) {
    if (unanswered > 0) map[static_cast<std::size_t>(unanswered)] = -1;
    EXPECT_EQ(score_map(map, truth_of(rows, rows), scale(), 1).found, unanswered == 0);
    EXPECT_EQ(score_map(map, truth_of(rows, rows, true), scale(), 1).found, unanswered < 2);
  }
}

TEST(ScoreMap, FindsNothingAtAMeanOfFiveAndMore) {
  Vertices map = identity();
  map[0] = 2;
  EXPECT_TRUE(score_map(map, truth_of({0, 1}, {0, 1}), scale(), 1).found);  // 3.5
  EXPECT_FALSE(score_map(map, truth_of({0}, {0}), scale(), 1).found);       // 7.1
  EXPECT_EQ(score_map(map, truth_of({0}, {0}), scale(), 1).below5, 0.0);
}

TEST(ScoreMap, HasNoMeanWithoutAnswers) {
  const MapScore score =
      score_map(Vertices(kPoints, -1), truth_of({0, 1}, {0, 1}, true), scale(), 1);
  EXPECT_TRUE(std::isnan(score.mean_error));
  EXPECT_EQ(score.matched, 0.0);
  EXPECT_EQ(score.below5, 0.0);
  EXPECT_FALSE(score.found);
  const MapScore empty = score_map({}, {}, scale(), 1);
  EXPECT_EQ(empty.share_below(1.0), 0.0);
  EXPECT_FALSE(empty.found);
}

TEST(ScoreMap, RefusesAMapThatDoesNotFit) {
  EXPECT_EQ(refusal([] {
              (void)score_map({0, 1}, truth_of({2}, {2}), scale(), 1);
            }),
            "map: has 2 entries; the truth asks for vertex 2");
  EXPECT_EQ(refusal([] { (void)score_map({kPoints}, truth_of({0}, {0}), scale(), 1); }),
            "distances: 861 is no vertex; the mesh has 861, from 0");
}

TEST(SymmetryError, IsTheRadiusOfATwentiethOfTheArea) {
  EXPECT_NEAR(kSymmetryError, 100.0 / std::sqrt(20.0 * std::numbers::pi), 1e-12);
}

}  // namespace
}  // namespace timbre
