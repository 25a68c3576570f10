#include "timbre/cli/render/camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace timbre::cli {
namespace {

// Half the shorter side at unit distance: 23 degrees across, near to a portrait lens.
constexpr double kHalfField = 0.2;
// The share of the picture's width or height that the object may fill.
constexpr double kFilled = 0.94;

// Along one side of the picture, a point at `across` and `depth` is seen from (middle,
// back) if |across - middle| <= slope (depth - back).
struct Fit {
  double middle = 0.0;
  double back = 0.0;
};

Fit fit_across(const Eigen::VectorXd& across, const Eigen::VectorXd& depth, double slope) {
  const double high = (across - slope * depth).maxCoeff();
  const double low = (-across - slope * depth).maxCoeff();
  return {0.5 * (high - low), -0.5 * (high + low) / slope};
}

}  // namespace

Eigen::Matrix3d rotation_to_y_up(UpAxis up) {
  Eigen::Matrix3d rotation;
  switch (up) {
    case UpAxis::x:
      rotation << 0, 0, 1, 1, 0, 0, 0, 1, 0;
      break;
    case UpAxis::minus_x:
      rotation << 0, 0, -1, -1, 0, 0, 0, 1, 0;
      break;
    case UpAxis::y:
      rotation.setIdentity();
      break;
    case UpAxis::minus_y:
      rotation << -1, 0, 0, 0, -1, 0, 0, 0, 1;
      break;
    case UpAxis::z:
      rotation << 1, 0, 0, 0, 0, 1, 0, -1, 0;
      break;
    case UpAxis::minus_z:
      rotation << 1, 0, 0, 0, 0, -1, 0, 1, 0;
      break;
  }
  return rotation;
}

Camera fit_camera(const Points& points, const View& view, double aspect) {
  const double azimuth = view.azimuth * std::numbers::pi / 180.0;
  const double elevation = view.elevation * std::numbers::pi / 180.0;
  Camera camera;
  camera.right = {std::cos(azimuth), 0.0, -std::sin(azimuth)};
  camera.forward = {-std::sin(azimuth) * std::cos(elevation), -std::sin(elevation),
                    -std::cos(azimuth) * std::cos(elevation)};
  camera.up = camera.right.cross(camera.forward);
  camera.half_width = kHalfField * std::max(1.0, aspect);
  camera.half_height = kHalfField * std::max(1.0, 1.0 / aspect);
  const Eigen::VectorXd depth = points * camera.forward;
  const Fit x = fit_across(points * camera.right, depth, kFilled * camera.half_width);
  const Fit y = fit_across(points * camera.up, depth, kFilled * camera.half_height);
  camera.eye =
      x.middle * camera.right + y.middle * camera.up + std::min(x.back, y.back) * camera.forward;
  return camera;
}

double distance_of(const Camera& camera) { return -camera.eye.dot(camera.forward); }

void withdraw(Camera& camera, double distance) {
  camera.eye -= std::max(0.0, distance - distance_of(camera)) * camera.forward;
}

}  // namespace timbre::cli
