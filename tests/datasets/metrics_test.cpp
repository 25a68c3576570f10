#include "timbre/datasets/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "timbre/analysis/core/error.h"

namespace timbre {
namespace {

// Points on a line; class a at 0, 1, 4, class b at 2, 2.5, class c alone at 9.
const Eigen::VectorXd kPlaces = (Eigen::VectorXd(6) << 0, 1, 4, 2, 2.5, 9).finished();
const std::vector<std::string> kLabels = {"a", "a", "a", "b", "b", "c"};

Eigen::VectorXd row_of(Eigen::Index i) { return (kPlaces.array() - kPlaces(i)).abs(); }

RetrievalScores scores_of(Eigen::Index query) {
  std::vector<double> distances;
  std::vector<bool> relevant;
  const Eigen::VectorXd row = row_of(query);
  for (Eigen::Index i = 0; i < 6; ++i) {
    if (i == query) continue;
    distances.push_back(row(i));
    relevant.push_back(kLabels[static_cast<std::size_t>(i)] ==
                       kLabels[static_cast<std::size_t>(query)]);
  }
  return score_ranking(distances, relevant);
}

void expect_scores(const RetrievalScores& s, double nn, double ft, double st, double e, double dcg,
                   double ap) {
  EXPECT_DOUBLE_EQ(s.nearest, nn);
  EXPECT_DOUBLE_EQ(s.first_tier, ft);
  EXPECT_DOUBLE_EQ(s.second_tier, st);
  EXPECT_NEAR(s.e_measure, e, 1e-15);
  EXPECT_NEAR(s.dcg, dcg, 1e-15);
  EXPECT_NEAR(s.average_precision, ap, 1e-15);
}

TEST(ScoreRanking, AgreesWithTheCaseWorkedByHand) {
  const double e = 2.0 * 0.4 * 1.0 / 1.4;
  expect_scores(scores_of(0), 1, 0.5, 1, e, 0.75, 0.75);
  expect_scores(scores_of(1), 0, 0.5, 1, e, 0.75, 0.5);  // a tie, decided against it
  expect_scores(scores_of(2), 0, 0.0, 1, e, (1.0 / std::log2(3.0) + 0.5) / 2.0,
                (1.0 / 3 + 0.5) / 2);
  expect_scores(scores_of(3), 1, 1.0, 1, 2.0 * 0.2 / 1.2, 1.0, 1.0);
}

void expect_precision(const RetrievalScores& s, double first_half, double second_half) {
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_NEAR(s.precision[i], i < 10 ? first_half : second_half, 1e-15) << i;
  }
}

// Of two relevant items the first makes a recall of a half.
TEST(ScoreRanking, InterpolatesPrecisionAsWorkedByHand) {
  expect_precision(scores_of(0), 1.0, 0.5);  // hits at ranks 1 and 4
  expect_precision(scores_of(1), 0.5, 0.5);  // 2 and 4
  expect_precision(scores_of(2), 0.5, 0.5);  // 3 and 4: the later is the better
  expect_precision(scores_of(3), 1.0, 1.0);
  expect_precision(evaluate_retrieval(kLabels, row_of).micro, 0.8, 0.7);
  expect_precision(evaluate_retrieval(kLabels, row_of).macro, (2.0 / 3 + 1) / 2, 0.75);
}

TEST(ScoreRanking, CountsTiesAndUndefinedDistancesAgainstTheRanking) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  const std::vector<double> same = {1, 1, 1, 1};
  EXPECT_EQ(score_ranking(same, {true, false, false, false}).average_precision, 0.25);
  const std::vector<double> undefined = {kNaN, kInf, -kInf, 7};
  EXPECT_EQ(score_ranking(undefined, {true, false, false, false}).average_precision, 0.25);
  EXPECT_EQ(score_ranking(undefined, {false, false, false, true}).nearest, 1.0);
}

TEST(ScoreRanking, LooksAtThirtyTwoForTheEMeasure) {
  std::vector<double> distances(40);
  std::vector<bool> relevant(40, false);
  for (std::size_t i = 0; i < 40; ++i) distances[i] = static_cast<double>(i);
  relevant[0] = relevant[31] = relevant[32] = true;
  const double precision = 2.0 / 32.0;
  const double recall = 2.0 / 3.0;
  EXPECT_NEAR(score_ranking(distances, relevant).e_measure,
              2.0 * precision * recall / (precision + recall), 1e-15);
}

TEST(ScoreRanking, RefusesAQueryWithoutRelevantItems) {
  EXPECT_THROW((void)score_ranking(std::vector<double>{1.0}, {false}), Error);
  EXPECT_THROW((void)score_ranking(std::vector<double>{1.0, 2.0}, {true}), Error);
}

TEST(EvaluateRetrieval, AgreesWithTheCaseWorkedByHand) {
  const RetrievalReport report = evaluate_retrieval(kLabels, row_of);
  EXPECT_EQ(report.queries, 5);
  EXPECT_EQ(report.shapes, 6);
  EXPECT_EQ(report.undefined, 0);
  EXPECT_NEAR(report.micro.average_precision, (0.75 + 0.5 + 5.0 / 12 + 1 + 1) / 5, 1e-15);
  EXPECT_NEAR(report.macro.average_precision, ((0.75 + 0.5 + 5.0 / 12) / 3 + 1) / 2, 1e-15);
  ASSERT_EQ(report.classes.size(), 2U);
  EXPECT_EQ(report.classes[0].label, "a");
  EXPECT_EQ(report.classes[0].queries, 3);
}

TEST(EvaluateRetrieval, GivesNothingForAConstantDescriptor) {
  const RetrievalReport report =
      evaluate_retrieval(kLabels, [](Eigen::Index) { return Eigen::VectorXd::Zero(6); });
  EXPECT_EQ(report.micro.nearest, 0.0);
}

TEST(EvaluateRetrieval, TakesUnlabelledShapesAsDistractorsOnly) {
  const RetrievalReport report = evaluate_retrieval({"a", "a", "", "", "b", "b"}, row_of);
  EXPECT_EQ(report.queries, 4);
  EXPECT_EQ(report.classes.size(), 2U);
  EXPECT_THROW((void)evaluate_retrieval({"", "", "x", "y", "z", ""}, row_of), Error);
}

TEST(EvaluateRetrieval, CountsUndefinedDistancesButNotTheQueryItself) {
  const RetrievalReport report = evaluate_retrieval(kLabels, [](Eigen::Index i) {
    Eigen::VectorXd row = row_of(i);
    row(i) = row(5) = std::numeric_limits<double>::quiet_NaN();
    return row;
  });
  EXPECT_EQ(report.undefined, 5);
}

}  // namespace
}  // namespace timbre
