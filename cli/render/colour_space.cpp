#include "timbre/cli/render/colour_space.h"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace timbre::cli {
namespace {

// The matrices of OKLab: linear sRGB to cone responses, and their cube roots to (L, a, b).
const Eigen::Matrix3d& cones() {
  static const Eigen::Matrix3d kCones =
      (Eigen::Matrix3d() << 0.4122214708, 0.5363325363, 0.0514459929, 0.2119034982, 0.6806995451,
       0.1073969566, 0.0883024619, 0.2817188376, 0.6299787005)
          .finished();
  return kCones;
}

const Eigen::Matrix3d& opponents() {
  static const Eigen::Matrix3d kOpponents =
      (Eigen::Matrix3d() << 0.2104542553, 0.7936177850, -0.0040720468, 1.9779984951, -2.4285922050,
       0.4505937099, 0.0259040371, 0.7827717662, -0.8086757660)
          .finished();
  return kOpponents;
}

Eigen::Vector3d linear_of(const Eigen::Vector3d& oklab) {
  static const Eigen::Matrix3d kFromOpponents = opponents().inverse();
  static const Eigen::Matrix3d kFromCones = cones().inverse();
  const Eigen::Vector3d roots = kFromOpponents * oklab;
  return kFromCones * roots.array().cube().matrix();
}

double luminance(const Eigen::Vector3d& linear) {
  return linear.dot(Eigen::Vector3d(0.2126, 0.7152, 0.0722));
}

double lightness(double luminance) {
  constexpr double kLinearPart = 216.0 / 24389.0;
  return luminance > kLinearPart ? 116.0 * std::cbrt(luminance) - 16.0 : luminance * 24389.0 / 27.0;
}

bool is_shown(const Eigen::Vector3d& linear) {
  constexpr double kSlack = 1e-6;
  return linear.minCoeff() >= -kSlack && linear.maxCoeff() <= 1.0 + kSlack;
}

// Both halvings stop where no picture of 8 bits could tell a difference.
constexpr int kHalvings = 24;

// OKLab's own L is not CIE's: it is sought.
Eigen::Vector3d linear_with(double wanted, double chroma, double hue) {
  const double a = chroma * std::cos(hue);
  const double b = chroma * std::sin(hue);
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (lightness(luminance(linear_of({middle, a, b}))) < wanted ? low : high) = middle;
  }
  return linear_of({0.5 * (low + high), a, b});
}

}  // namespace

Colour to_linear(const Colour& srgb) {
  return srgb.unaryExpr(
      [](float v) { return v <= 0.04045F ? v / 12.92F : std::pow((v + 0.055F) / 1.055F, 2.4F); });
}

Colour to_srgb(const Colour& linear) {
  return linear.unaryExpr([](float v) {
    return v <= 0.0031308F ? 12.92F * v : 1.055F * std::pow(v, 1.0F / 2.4F) - 0.055F;
  });
}

double lightness_of(const Colour& srgb) {
  return lightness(luminance(to_linear(srgb).cast<double>()));
}

Colour colour_of(double wanted, double chroma, double hue) {
  const double angle = hue * std::numbers::pi / 180.0;
  Eigen::Vector3d linear = linear_with(wanted, chroma, angle);
  if (!is_shown(linear)) {
    double low = 0.0;
    double high = chroma;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      (is_shown(linear_with(wanted, middle, angle)) ? low : high) = middle;
    }
    linear = linear_with(wanted, low, angle);
  }
  return to_srgb(linear.cwiseMax(0.0).cwiseMin(1.0).cast<float>());
}

Eigen::Vector3d to_oklab(const Colour& srgb) {
  const Eigen::Vector3d responses = cones() * to_linear(srgb).cast<double>();
  return opponents() * responses.unaryExpr([](double v) { return std::cbrt(v); });
}

}  // namespace timbre::cli
