#include "timbre/analysis/signatures/shape_dna.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "timbre/analysis/core/error.h"

namespace timbre {
namespace {

Spectrum with_values(const Eigen::VectorXd& values) {
  Spectrum spectrum;
  spectrum.values = values;
  return spectrum;
}

TEST(ComputeShapeDna, LeavesOutTheFirstEigenvalueAndFollowsTheFormulas) {
  const Spectrum spectrum = with_values(Eigen::Vector3d(0.0, 10.0, 30.0));
  const auto of = [&](ShapeDnaForm form) { return compute_shape_dna(spectrum, form); };
  EXPECT_EQ(of(ShapeDnaForm::plain), Eigen::Vector2d(10.0, 30.0));
  EXPECT_EQ(of(ShapeDnaForm::per_index), Eigen::Vector2d(10.0, 15.0));
  EXPECT_EQ(of(ShapeDnaForm::logarithm), Eigen::Vector2d(std::log(10.001), std::log(30.001)));
  EXPECT_EQ(of(ShapeDnaForm::weighted), Eigen::Vector2d(100.0 / 15.0, 100.0 / 35.0));
  EXPECT_EQ(of(ShapeDnaForm::weyl),
            Eigen::Vector2d(10.0 / (4.0 * std::numbers::pi), 30.0 / (8.0 * std::numbers::pi)));
}

TEST(ComputeShapeDna, TendsToOneByWeylsLawOnTheSphere) {
  Eigen::VectorXd values(101 * 101);
  for (int l = 0, i = 0; l <= 100; ++l) {
    for (int m = -l; m <= l; ++m) values(i++) = 4.0 * std::numbers::pi * l * (l + 1);
  }
  const Eigen::VectorXd dna = compute_shape_dna(with_values(values), ShapeDnaForm::weyl, 10000);
  EXPECT_NEAR(dna.tail(200).mean(), 1.0, 0.01);
}

TEST(ComputeShapeDna, KeepsTheZerosOfFurtherComponentsFinite) {
  const Spectrum spectrum = with_values(Eigen::Vector3d(0.0, 0.0, 5.0));
  const Eigen::VectorXd dna = compute_shape_dna(spectrum, ShapeDnaForm::logarithm);
  EXPECT_DOUBLE_EQ(dna(0), std::log(1e-3));
}

TEST(ComputeShapeDna, IsShorterForAShortSpectrumAndRefusesNone) {
  EXPECT_EQ(
      compute_shape_dna(with_values(Eigen::Vector3d(0, 1, 2)), ShapeDnaForm::plain, 100).size(), 2);
  EXPECT_EQ(compute_shape_dna(with_values(Eigen::Vector3d(0, 1, 2)), ShapeDnaForm::plain, 1).size(),
            1);
  EXPECT_THROW((void)compute_shape_dna(with_values(Eigen::VectorXd::Zero(1)), ShapeDnaForm::plain),
               Error);
  EXPECT_THROW((void)compute_shape_dna(with_values(Eigen::Vector2d(0, 1)), ShapeDnaForm::plain, 0),
               Error);
}

}  // namespace
}  // namespace timbre
