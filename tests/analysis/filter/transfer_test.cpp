#include "timbre/analysis/filter/transfer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "timbre/analysis/core/error.h"
#include "timbre/tests/support/refused_request.h"

namespace timbre {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

std::string refused_table(const Eigen::MatrixX2d& points) {
  try {
    (void)piecewise_linear(points);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    return error.what();
  }
  return "no error";
}

TEST(LowPass, IncludesItsCutoff) {
  const Transfer pass = low_pass(3.0);
  EXPECT_EQ(pass(0.0), 1.0);
  EXPECT_EQ(pass(3.0), 1.0);
  EXPECT_EQ(pass(std::nextafter(3.0, 4.0)), 0.0);
}

TEST(Band, IncludesBothEnds) {
  const Transfer doubled = band(2.0, 3.0, 2.0, 0.5);
  EXPECT_EQ(doubled(std::nextafter(2.0, 1.0)), 0.5);
  EXPECT_EQ(doubled(2.0), 2.0);
  EXPECT_EQ(doubled(3.0), 2.0);
  EXPECT_EQ(doubled(std::nextafter(3.0, 4.0)), 0.5);
}

TEST(Heat, DecaysAndKeepsConstants) {
  EXPECT_EQ(heat(5.0)(0.0), 1.0);
  EXPECT_DOUBLE_EQ(heat(0.5)(4.0), std::exp(-2.0));
  EXPECT_EQ(heat(0.0)(1e9), 1.0);
}

TEST(SmoothingSteps, IsAPower) {
  EXPECT_DOUBLE_EQ(smoothing_steps(0.5, 3)(0.4), 0.8 * 0.8 * 0.8);
  EXPECT_EQ(smoothing_steps(0.5, 0)(2.0), 1.0);
  EXPECT_DOUBLE_EQ(smoothing_steps(1.0, 1)(2.0), -1.0);
}

TEST(PiecewiseLinear, RunsStraightBetweenPointsAndLevelBeyond) {
  Eigen::MatrixX2d points(3, 2);
  points << 1.0, 1.0, 2.0, 3.0, 4.0, 0.0;
  const Transfer f = piecewise_linear(points);
  EXPECT_EQ(f(0.0), 1.0);
  EXPECT_EQ(f(1.0), 1.0);
  EXPECT_EQ(f(1.25), 1.5);
  EXPECT_EQ(f(2.0), 3.0);
  EXPECT_EQ(f(3.0), 1.5);
  EXPECT_EQ(f(4.0), 0.0);
  EXPECT_EQ(f(100.0), 0.0);
  EXPECT_EQ(piecewise_linear(points.topRows(1))(7.0), 1.0);
}

TEST(PiecewiseLinear, RefusesWhatIsNoFunction) {
  EXPECT_EQ(refused_table(Eigen::MatrixX2d(0, 2)), "transfer: has no points");
  Eigen::MatrixX2d points(2, 2);
  points << 1.5, 1.0, 1.5, 2.0;
  EXPECT_EQ(refused_table(points), "point 1: lambda 1.5 is not above 1.5 before it");
  points << 1.0, 1.0, 2.0, kNoNumber;
  EXPECT_EQ(refused_table(points), "point 1: is not finite");
}

TEST(Transfers, RefuseArgumentsWithoutMeaning) {
  EXPECT_EQ(refused_request([] { (void)heat(-1.0); }), "transfer: heat needs a time of at least 0");
  EXPECT_EQ(refused_request([] { (void)heat(kNoNumber); }),
            "transfer: heat needs a time of at least 0");
  EXPECT_EQ(refused_request([] { (void)band(2.0, 1.0, 1.0, 0.0); }),
            "transfer: a band needs ends in order and finite factors");
  EXPECT_EQ(refused_request([] { (void)band(1.0, 2.0, kNoNumber, 0.0); }),
            "transfer: a band needs ends in order and finite factors");
  EXPECT_EQ(refused_request([] { (void)smoothing_steps(0.5, -1); }),
            "transfer: smoothing needs at least 0 steps");
}

}  // namespace
}  // namespace timbre
