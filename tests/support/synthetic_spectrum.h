#pragma once

#include <Eigen/Core>
#include <Eigen/QR>
#include <cmath>
#include <numbers>
#include <random>

#include "timbre/analysis/spectrum/spectrum.h"

namespace timbre {

/// Given values with orthonormal columns drawn from a fixed seed; as many zeros as stand
/// in front.
inline Spectrum synthetic_spectrum(const Eigen::VectorXd& values, Eigen::Index vertices,
                                   unsigned seed = 1) {
  std::mt19937 draw(seed);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd any(vertices, values.size());
  for (double& entry : any.reshaped()) entry = normal(draw);
  Spectrum spectrum;
  spectrum.values = values;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(any);
  spectrum.vectors = qr.householderQ() * Eigen::MatrixXd::Identity(vertices, values.size());
  while (spectrum.zeros < values.size() && values(spectrum.zeros) == 0.0) ++spectrum.zeros;
  return spectrum;
}

/// Mixes columns `first` and `first + 1` by an angle, and flips the sign of a third.
inline Spectrum turned(Spectrum spectrum, Eigen::Index first, double angle, Eigen::Index flipped) {
  Eigen::Matrix2d R;
  R << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  spectrum.vectors.middleCols(first, 2) = (spectrum.vectors.middleCols(first, 2) * R).eval();
  spectrum.vectors.col(flipped) *= -1.0;
  return spectrum;
}

}  // namespace timbre
