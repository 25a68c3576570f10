#pragma once

#include <cstddef>
#include <span>

namespace timbre {

/// A power of two near the largest coordinate: multiplication by `1 / unit` is exact and
/// leaves numbers below 2, whose squares and products do not overflow.
[[nodiscard]] double unit_of(std::span<const double> coordinates);

/// Area in squares of a unit, of a triangle given by three positions in space.
/// @param per_unit  1 / unit
[[nodiscard]] double triangle_area(const double* a, const double* b, const double* c,
                                   double per_unit);

namespace detail {

/// What `has_no_area` says of triangles that are flat, or whose products are far from 1.
[[nodiscard]] bool has_no_area_at_any_scale(const double* a, const double* b, const double* c,
                                            double per_unit);

}  // namespace detail

/// Whether twice the area is at most 1e-15 of the longest edge squared. The size of the
/// triangle does not matter: neither 1e300 nor 1e-200 is an alarm.
[[nodiscard]] inline bool has_no_area(const double* a, const double* b, const double* c,
                                      double per_unit) {
  // Nearly all triangles are far from flat, and far from where squares over- or underflow.
  const double u[] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  const double v[] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  const double n[] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                      u[0] * v[1] - u[1] * v[0]};
  const double edges = u[0] * u[0] + u[1] * u[1] + u[2] * u[2] +  //
                       v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  constexpr double kFar = 1e60;
  const bool is_fat = n[0] * n[0] + n[1] * n[1] + n[2] * n[2] > 1e-28 * edges * edges;
  if (is_fat && edges > 1.0 / kFar && edges < kFar) return false;
  return detail::has_no_area_at_any_scale(a, b, c, per_unit);
}

}  // namespace timbre
