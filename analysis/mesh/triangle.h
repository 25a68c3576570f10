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

/// Whether twice the area is at most 1e-15 of the longest edge squared. The size of the
/// triangle does not matter: neither 1e300 nor 1e-200 is an alarm.
[[nodiscard]] bool has_no_area(const double* a, const double* b, const double* c, double per_unit);

}  // namespace timbre
