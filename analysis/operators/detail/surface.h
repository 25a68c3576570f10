#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre::detail {

/// A triangle with three different corners, by the lengths of its edges.
struct MetricFace {
  std::array<std::int32_t, 3> corner{};
  std::array<double, 3> length{};  ///< length[c] lies opposite corner[c]
};

/// A connected component and its own unit of length: one far smaller than another neither
/// underflows beside it nor is mollified by the other's measure.
struct ComponentScale {
  int exponent = 0;  ///< lengths count in units of 2^exponent
  double mean_length = 0.0;
  double raise = 0.0;  ///< added to each length by mollification
};

/// What the operators know of a mesh: lengths, and which vertices hang together.
struct Surface {
  std::vector<MetricFace> faces;
  std::vector<std::int32_t> component;  ///< of each vertex, -1 if it lies in none of `faces`
  std::vector<ComponentScale> scales;   ///< one a component
  int left_out = 0;                     ///< components without any area; their faces are not here

  [[nodiscard]] Eigen::Index vertices() const {
    return static_cast<Eigen::Index>(component.size());
  }
  [[nodiscard]] const ComponentScale& scale_at(std::int32_t vertex) const {
    return scales[static_cast<std::size_t>(component[static_cast<std::size_t>(vertex)])];
  }
};

/// Faces with a repeated corner, and components in which no face has area, are left out. Lengths
/// are differences of coordinates divided by a power of two: neither a far origin nor an extreme
/// unit is felt. Those of a component with triangles thinner than `mollification` mean lengths
/// are all raised by the same small amount (Sharp and Crane 2020, section 4.5).
///
/// @throws Error  bad_input for a corner that is no vertex, a coordinate that is not finite, or
///                if nothing is left; bad_request for negative mollification
[[nodiscard]] Surface make_surface(const TriangleMesh& mesh, double mollification);

/// The same from lengths alone; lengths(f, c) lies opposite corner c.
[[nodiscard]] Surface make_surface(const Faces& faces, const Points& lengths, Eigen::Index vertices,
                                   double mollification);

/// Area by Heron's formula in Kahan's order, which keeps its digits on needles.
[[nodiscard]] double triangle_area(std::array<double, 3> length);

/// Cotangents of the angles at the corners.
/// @param area  of this triangle
[[nodiscard]] std::array<double, 3> cotangents(const std::array<double, 3>& length, double area);

}  // namespace timbre::detail
