#include "timbre/analysis/embedding/embedding.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "timbre/analysis/core/error.h"
#include "timbre/tests/support/synthetic_spectrum.h"

namespace timbre {
namespace {

const Eigen::VectorXd kValues = (Eigen::VectorXd(6) << 0, 2, 5, 5, 9, 14).finished();

Eigen::MatrixXd distances(const Eigen::MatrixXd& X) {
  Eigen::MatrixXd D(X.rows(), X.rows());
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    for (Eigen::Index j = 0; j < X.rows(); ++j) D(i, j) = (X.row(i) - X.row(j)).norm();
  }
  return D;
}

class EmbeddingOfAnyKind : public testing::TestWithParam<EmbeddingKind> {};

TEST_P(EmbeddingOfAnyKind, WeighsEigenfunctionsByItsFormula) {
  const Spectrum spectrum = synthetic_spectrum(kValues, 12);
  const Eigen::MatrixXd X = compute_embedding(spectrum, {.kind = GetParam(), .time = 0.1});
  ASSERT_EQ(X.cols(), 5);
  for (int i = 0; i < 5; ++i) {
    const double lambda = kValues(i + 1);
    const double weight = GetParam() == EmbeddingKind::gps         ? 1.0 / std::sqrt(lambda)
                          : GetParam() == EmbeddingKind::diffusion ? std::exp(-0.1 * lambda)
                                                                   : 1.0 / lambda;
    EXPECT_LT((X.col(i) - weight * spectrum.vectors.col(i + 1)).norm(), 1e-15);
  }
}

TEST_P(EmbeddingOfAnyKind, HasDistancesThatDoNotSeeSignsAndRotations) {
  const Spectrum spectrum = synthetic_spectrum(kValues, 12);
  const EmbeddingOptions options = {.kind = GetParam()};
  const Eigen::MatrixXd before = distances(compute_embedding(spectrum, options));
  for (const double angle : {0.4, 2.2}) {
    const Eigen::MatrixXd after =
        distances(compute_embedding(turned(spectrum, 2, angle, 4), options));
    EXPECT_LT((after - before).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST_P(EmbeddingOfAnyKind, SkipsAllZerosAndCutsWhereAsked) {
  const Eigen::VectorXd values = (Eigen::VectorXd(5) << 0, 0, 0, 4, 6).finished();
  const Spectrum spectrum = synthetic_spectrum(values, 10);
  EXPECT_EQ(compute_embedding(spectrum, {.kind = GetParam()}).cols(), 2);
  EXPECT_EQ(compute_embedding(spectrum, {.kind = GetParam(), .dimensions = 1}).cols(), 1);
  EXPECT_TRUE(compute_embedding(spectrum, {.kind = GetParam()}).allFinite());
}

INSTANTIATE_TEST_SUITE_P(Kinds, EmbeddingOfAnyKind,
                         testing::Values(EmbeddingKind::gps, EmbeddingKind::diffusion,
                                         EmbeddingKind::biharmonic));

// Squared GPS distance is G(x, x) + G(y, y) - 2 G(x, y); on a circle of length 2 pi the
// Green's function is (pi^2 / 3 - pi d + d^2 / 2) / (2 pi), so it is d (2 pi - d) / (2 pi).
TEST(ComputeEmbedding, GivesTheResistanceOfACircle) {
  constexpr int kWaves = 4000;
  Spectrum circle;
  circle.zeros = 1;
  circle.values = Eigen::VectorXd::Zero(2 * kWaves + 1);
  circle.vectors = Eigen::MatrixXd::Zero(2, 2 * kWaves + 1);
  const double x[] = {0.0, 1.3};
  for (int k = 1; k <= kWaves; ++k) {
    circle.values(2 * k - 1) = circle.values(2 * k) = double(k) * k;
    for (int i = 0; i < 2; ++i) {
      circle.vectors(i, 2 * k - 1) = std::cos(k * x[i]) / std::sqrt(std::numbers::pi);
      circle.vectors(i, 2 * k) = std::sin(k * x[i]) / std::sqrt(std::numbers::pi);
    }
  }
  const Eigen::MatrixXd X = compute_embedding(circle);
  const double expected = 1.3 * (2.0 * std::numbers::pi - 1.3) / (2.0 * std::numbers::pi);
  EXPECT_NEAR((X.row(0) - X.row(1)).squaredNorm(), expected, 1e-3);
}

TEST(ComputeEmbedding, RefusesWhatHasNoMeaning) {
  EXPECT_THROW((void)compute_embedding(synthetic_spectrum(Eigen::VectorXd::Zero(2), 4)), Error);
  const Spectrum spectrum = synthetic_spectrum(kValues, 12);
  EXPECT_THROW((void)compute_embedding(spectrum, {.dimensions = -1}), Error);
  EXPECT_THROW((void)compute_embedding(spectrum, {.time = 0.0}), Error);
}

}  // namespace
}  // namespace timbre
