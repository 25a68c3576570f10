#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "timbre/datasets/isosurface.h"

namespace timbre::detail {

using Triangle = std::array<std::int32_t, 3>;

/// The part of a symmetric surface on one side of the plane x = 0; its border lies in
/// the plane, with x exactly 0.
struct HalfSurface {
  std::vector<Eigen::Vector3d> points;
  std::vector<Triangle> faces;

  [[nodiscard]] bool in_plane(std::int32_t v) const {
    return points[static_cast<std::size_t>(v)].x() == 0.0;
  }
};

/// First-order distance to the surface.
[[nodiscard]] double distance_estimate(const ImplicitValue& value);

/// A point near the surface, moved onto it; points of the plane stay in it.
[[nodiscard]] Eigen::Vector3d project(const ImplicitFunction& f, const Eigen::Vector3d& point);

/// Evens the triangles out: by turns flips edges and moves points towards the middle of
/// their neighbours, on the surface.
void relax(HalfSurface& surface, const ImplicitFunction& f, int rounds);

}  // namespace timbre::detail
