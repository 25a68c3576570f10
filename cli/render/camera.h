#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre::cli {

/// The axis of the mesh's own coordinates that points up in the picture.
enum class UpAxis : std::uint8_t { x, y, z, minus_x, minus_y, minus_z };

/// The rotation that takes mesh coordinates to those of the picture: y up, and z towards
/// whoever looks from the front. With z up that is the side of the smaller y.
[[nodiscard]] Eigen::Matrix3d rotation_to_y_up(UpAxis up);

/// Where to look from, in degrees around and above the object. Azimuth 0 is the front, 90
/// the side to the right of it.
struct View {
  double azimuth = 0.0;
  double elevation = 0.0;
};

/// A pinhole camera; the three directions are orthonormal.
struct Camera {
  Eigen::Vector3d eye, right, up, forward;
  double half_width = 0.0;   ///< of the picture at unit distance
  double half_height = 0.0;  ///< of the picture at unit distance
};

/// The nearest camera that sees all points, with a small margin, and has them in the middle.
///
/// @param points  n x 3, n at least 1
/// @param aspect  width over height
[[nodiscard]] Camera fit_camera(const Points& points, const View& view, double aspect);

/// How far the camera stands from the plane through the origin that faces it.
[[nodiscard]] double distance_of(const Camera& camera);

/// Moves a camera back to that distance; never forward.
void withdraw(Camera& camera, double distance);

}  // namespace timbre::cli
