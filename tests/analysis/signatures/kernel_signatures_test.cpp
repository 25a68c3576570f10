#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/signatures/heat_kernel.h"
#include "timbre/analysis/signatures/wave_kernel.h"
#include "timbre/tests/support/synthetic_spectrum.h"

namespace timbre {
namespace {

const Eigen::VectorXd kValues = (Eigen::VectorXd(7) << 0, 4, 9, 9, 16, 30, 55).finished();

TEST(HeatKernelTimes, SpanTheDesignedRangeEvenlyInTheLogarithm) {
  const Eigen::VectorXd times = heat_kernel_times(synthetic_spectrum(kValues, 20));
  ASSERT_EQ(times.size(), 64);
  EXPECT_NEAR(times(0), 4.0 * std::numbers::ln10 / 55.0, 1e-14);
  EXPECT_NEAR(times(63), 4.0 * std::numbers::ln10 / 4.0, 1e-13);
  EXPECT_NEAR(times(1) / times(0), times(63) / times(62), 1e-12);
}

TEST(ComputeHeatKernelSignature, IsTheSumOfDecayingSquares) {
  const Spectrum spectrum = synthetic_spectrum(kValues, 20);
  const Eigen::VectorXd times = Eigen::Vector2d(0.01, 0.3);
  const Eigen::MatrixXd plain =
      compute_heat_kernel_signature(spectrum, times, {.divide_by_trace = false});
  const Eigen::MatrixXd shared = compute_heat_kernel_signature(spectrum, times);
  for (int t = 0; t < 2; ++t) {
    double trace = 0.0;
    double heat = 0.0;
    for (int i = 1; i < 7; ++i) {
      trace += std::exp(-kValues(i) * times(t));
      heat += std::exp(-kValues(i) * times(t)) * std::pow(spectrum.vectors(3, i), 2);
    }
    EXPECT_NEAR(plain(3, t), heat, 1e-14);
    EXPECT_NEAR(shared(3, t), heat / trace, 1e-14);
    // Columns of `vectors` have unit length, so divided by the trace each time sums to 1.
    EXPECT_NEAR(shared.col(t).sum(), 1.0, 1e-12);
  }
}

// Real eigenfunctions of a circle of length 2 pi: the kernel is the same at each point.
TEST(ComputeHeatKernelSignature, IsConstantOnACircle) {
  Spectrum circle;
  circle.values = Eigen::VectorXd(5);
  circle.values << 0, 1, 1, 4, 4;
  circle.vectors.resize(12, 5);
  circle.zeros = 1;
  for (int j = 0; j < 12; ++j) {
    const double x = 2.0 * std::numbers::pi * j / 12.0;
    const double a = 1.0 / std::sqrt(std::numbers::pi);
    circle.vectors.row(j) << 1.0 / std::sqrt(2.0 * std::numbers::pi), a * std::cos(x),
        a * std::sin(x), a * std::cos(2 * x), a * std::sin(2 * x);
  }
  const Eigen::MatrixXd heat = compute_heat_kernel_signature(
      circle, Eigen::VectorXd::Constant(1, 0.7), {.divide_by_trace = false});
  const double expected = (std::exp(-0.7) + std::exp(-2.8)) / std::numbers::pi;
  EXPECT_LT((heat.array() - expected).abs().maxCoeff(), 1e-15);
  const Eigen::MatrixXd wave = compute_wave_kernel_signature(circle, wave_kernel_bands(circle));
  EXPECT_LT((wave.array() - 1.0 / (2.0 * std::numbers::pi)).abs().maxCoeff(), 1e-14);
}

TEST(KernelSignatures, DoNotSeeSignsAndRotationsInsideAnEigenspace) {
  const Spectrum spectrum = synthetic_spectrum(kValues, 20);
  const Eigen::VectorXd times = heat_kernel_times(spectrum);
  const WaveKernelBands bands = wave_kernel_bands(spectrum);
  for (const double angle : {0.3, 1.7, 3.0}) {
    const Spectrum other = turned(spectrum, 2, angle, 5);
    EXPECT_LT((compute_heat_kernel_signature(spectrum, times) -
               compute_heat_kernel_signature(other, times))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-15);
    EXPECT_LT((compute_wave_kernel_signature(spectrum, bands) -
               compute_wave_kernel_signature(other, bands))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-15);
  }
}

TEST(KernelSignatures, SkipAllZeros) {
  const Eigen::VectorXd two = (Eigen::VectorXd(5) << 0, 0, 3, 5, 8).finished();
  Spectrum spectrum = synthetic_spectrum(two, 15);
  const Eigen::VectorXd times = heat_kernel_times(spectrum);
  EXPECT_NEAR(times(63), 4.0 * std::numbers::ln10 / 3.0, 1e-13);
  const Eigen::MatrixXd before = compute_heat_kernel_signature(spectrum, times);
  spectrum.vectors.leftCols(2).setConstant(100.0);
  EXPECT_EQ(compute_heat_kernel_signature(spectrum, times), before);
}

TEST(WaveKernelBands, FollowAubry) {
  const WaveKernelBands bands = wave_kernel_bands(synthetic_spectrum(kValues, 20));
  ASSERT_EQ(bands.energies.size(), 100);
  EXPECT_DOUBLE_EQ(bands.energies(0), std::log(4.0));
  EXPECT_DOUBLE_EQ(bands.energies(99), std::log(55.0) / 1.02);
  EXPECT_NEAR(bands.sigma, 7.0 * (bands.energies(1) - bands.energies(0)), 1e-14);
}

TEST(KernelSignatures, RefuseSpectraThatHoldTooLittle) {
  const Spectrum constant = synthetic_spectrum(Eigen::VectorXd::Zero(1), 5);
  EXPECT_THROW((void)heat_kernel_times(constant), Error);
  EXPECT_THROW((void)compute_heat_kernel_signature(constant, Eigen::VectorXd::Ones(1)), Error);
  EXPECT_THROW((void)wave_kernel_bands(constant), Error);
  EXPECT_THROW((void)wave_kernel_bands(synthetic_spectrum(Eigen::Vector3d(0, 25, 25), 5)), Error);
}

}  // namespace
}  // namespace timbre
