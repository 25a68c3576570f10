#include "timbre/analysis/filter/closed_curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "timbre/analysis/filter/reconstruction.h"
#include "timbre/analysis/filter/spectral_filter.h"
#include "timbre/analysis/filter/spectral_transform.h"
#include "timbre/tests/support/refused_request.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::MatrixX2d;
using Eigen::MatrixXd;
using std::numbers::pi;

double difference(const MatrixXd& a, const MatrixXd& b) { return (a - b).cwiseAbs().maxCoeff(); }

// A rough outline, off the origin.
MatrixX2d outline(Index n) {
  MatrixX2d points(n, 2);
  for (Index j = 0; j < n; ++j) {
    const double t = 2.0 * pi * static_cast<double>(j) / static_cast<double>(n);
    const double r =
        1.0 + 0.3 * std::cos(3.0 * t + 0.2) + 0.1 * std::sin(17.0 * static_cast<double>(j * j));
    points.row(j) << 4.0 + r * std::cos(t), -2.0 + 0.6 * r * std::sin(t);
  }
  return points;
}

class CurveOfAnySize : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Sizes, CurveOfAnySize, testing::Values(3, 4, 5, 6, 12, 31, 64));

TEST_P(CurveOfAnySize, HasTheClosedFormAsItsSpectrum) {
  const int n = GetParam();
  const Operator op = closed_curve_operator(n);
  const Spectrum known = closed_curve_spectrum(n, n);
  for (int i = 0; i < n; ++i) {
    EXPECT_NEAR(known.values[i], 1.0 - std::cos(2.0 * pi * ((i + 1) / 2) / n), 1e-15);  // NOLINT
  }
  EXPECT_LT(difference(op.stiffness * known.vectors, known.vectors * known.values.asDiagonal()),
            1e-14);
  EXPECT_LT(known.orthonormality, 1e-13);
  EXPECT_LT(difference(known.vectors.transpose() * known.vectors, MatrixXd::Identity(n, n)), 1e-13);
  EXPECT_LT(difference(compute_spectrum(op, {.count = n}).values, known.values), 1e-12);
  EXPECT_EQ(known.zeros, 1);
}

TEST_P(CurveOfAnySize, MovesByTheFilterOfLaplacianSmoothing) {  // equation 8
  const MatrixX2d points = outline(GetParam());
  const Spectrum all = closed_curve_spectrum(GetParam(), GetParam());
  for (const double step : {0.5, 0.9, 0.1}) {
    EXPECT_LT(difference(smooth_closed_curve(points, step, 7),
                         apply_filter(all, closed_curve_operator(GetParam()).mass, points,
                                      smoothing_steps(step, 7))),
              1e-13)
        << step;
  }
}

TEST_P(CurveOfAnySize, HasTheFourierTransformInItsCoefficients) {
  const Index n = GetParam();
  const MatrixX2d points = outline(n);
  const MatrixXd coefficients =
      forward_transform(closed_curve_spectrum(n, n), closed_curve_operator(n).mass, points);
  const Eigen::MatrixXcd dft = to_dft(coefficients);
  for (Index m = 0; m < n; ++m) {
    Eigen::RowVector2cd sum = Eigen::RowVector2cd::Zero();
    for (Index j = 0; j < n; ++j) {
      sum += points.row(j) *
             std::polar(1.0 / static_cast<double>(n),
                        -2.0 * pi * static_cast<double>(m * j % n) / static_cast<double>(n));
    }
    EXPECT_LT((dft.row(m) - sum).norm(), 1e-14) << m;
  }
}

TEST(ClosedCurve, HasTheLaplacianOfTheCourse) {  // equation 3
  MatrixXd L(4, 4);
  L << 1.0, -0.5, 0.0, -0.5,  //
      -0.5, 1.0, -0.5, 0.0,   //
      0.0, -0.5, 1.0, -0.5,   //
      -0.5, 0.0, -0.5, 1.0;
  EXPECT_EQ(MatrixXd(closed_curve_operator(4).stiffness), L);
  EXPECT_EQ(MatrixXd(closed_curve_operator(4).mass), MatrixXd::Identity(4, 4));
}

TEST(ClosedCurve, KnowsItsLowestPairsAlone) {
  const Spectrum all = closed_curve_spectrum(31, 31);
  const Spectrum some = closed_curve_spectrum(31, 6);
  EXPECT_EQ(some.vectors, all.vectors.leftCols(6));
  EXPECT_EQ(some.values, all.values.head(6));
}

TEST(ClosedCurve, IsSmoothedByMidpointsTwice) {  // equation 1
  const MatrixX2d points = outline(12);
  MatrixX2d twice = points;
  for (int turn = 0; turn < 2; ++turn) {
    const MatrixX2d before = twice;
    for (Index j = 0; j < 12; ++j) {  // back by one the second time: numbers stay
      twice.row(j) = 0.5 * (before.row(j) + before.row((j + (turn == 0 ? 1 : 11)) % 12));
    }
  }
  EXPECT_LT(difference(smooth_closed_curve(points, 0.5, 1), twice), 1e-15);
}

TEST(ClosedCurve, ShrinksToItsCentroid) {
  const MatrixX2d points = outline(24);
  const Eigen::RowVector2d centroid = points.colwise().mean();
  for (const double step : {0.3, 0.5, 0.99}) {
    EXPECT_LT(difference(smooth_closed_curve(points, step, 5000), centroid.replicate(24, 1)),
              1e-12);
  }
}

// Scaled back by the factor of the lowest frequency, what is left is c + a cos + b sin.
TEST(ClosedCurve, BecomesAnAffineRegularPolygonOnTheWay) {
  const Index n = 24;
  const MatrixX2d points = outline(n);
  const Eigen::RowVector2d centroid = points.colwise().mean();
  Eigen::RowVector2d a = Eigen::RowVector2d::Zero();
  Eigen::RowVector2d b = Eigen::RowVector2d::Zero();
  const auto turn = [](Index j) {
    return 2.0 * pi * static_cast<double>(j) / static_cast<double>(n);
  };
  for (Index j = 0; j < n; ++j) {
    a += 2.0 / static_cast<double>(n) * std::cos(turn(j)) * points.row(j);
    b += 2.0 / static_cast<double>(n) * std::sin(turn(j)) * points.row(j);
  }
  MatrixX2d limit(n, 2);
  for (Index j = 0; j < n; ++j)
    limit.row(j) = centroid + std::cos(turn(j)) * a + std::sin(turn(j)) * b;

  const int steps = 300;
  const double factor = std::pow(1.0 - 0.5 * (1.0 - std::cos(turn(1))), steps);
  const MatrixX2d smoothed = smooth_closed_curve(points, 0.5, steps);
  const MatrixX2d scaled = ((smoothed.rowwise() - centroid) / factor).rowwise() + centroid;
  EXPECT_LT(difference(scaled, limit), 1e-5);

  const Spectrum lowest = closed_curve_spectrum(n, 3);
  const MatrixXd C = forward_transform(lowest, closed_curve_operator(n).mass, points);
  EXPECT_LT(difference(inverse_transform(lowest, C), limit), 1e-14);
}

TEST(ClosedCurve, IsCompressedWithAnErrorOfWhatIsLeftOut) {
  const Index n = 31;
  const MatrixX2d points = outline(n);
  const Spectrum all = closed_curve_spectrum(n, n);
  const SparseMatrix mass = closed_curve_operator(n).mass;
  const MatrixXd C = forward_transform(all, mass, points);
  const Reconstruction found = analyse_reconstruction(all, mass, points);
  const double variation = (points.rowwise() - points.colwise().mean()).norm();
  for (Index k = 1; k <= n; ++k) {
    EXPECT_NEAR(found.errors[k], (points - inverse_transform(all, C.topRows(k))).norm() / variation,
                1e-14);
    EXPECT_NEAR(found.errors[k], C.bottomRows(n - k).norm() / variation, 1e-14);
  }
  EXPECT_GT(found.errors[20], 1e-3);
}

TEST(ClosedCurve, RefusesWhatIsNoCurve) {
  const std::string line = "curve: has 2 points; a closed curve needs 3";
  EXPECT_EQ(refused_request([] { (void)closed_curve_operator(2); }), line);
  EXPECT_EQ(refused_request([] { (void)closed_curve_spectrum(2, 1); }), line);
  EXPECT_EQ(refused_request([] { (void)smooth_closed_curve(outline(2), 0.5, 1); }), line);
  EXPECT_EQ(refused_request([] { (void)to_dft(outline(2)); }), line);
  EXPECT_EQ(refused_request([] { (void)closed_curve_spectrum(5, 6); }),
            "count: 6 is not in the range 1 to 5");
  EXPECT_EQ(refused_request([] { (void)smooth_closed_curve(outline(5), 0.5, -1); }),
            "smoothing: needs at least 0 steps");
}

}  // namespace
}  // namespace timbre
