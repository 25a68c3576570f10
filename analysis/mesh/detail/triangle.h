#pragma once

#include <cstddef>
#include <span>

namespace timbre::detail {

/// A power of two near the largest coordinate; 1 if there is none but 0. Division by it
/// is exact and leaves numbers below 2, whose squares and products do not overflow.
[[nodiscard]] double unit_of(std::span<const double> coordinates);

/// Area in squares of `unit`, of a triangle given by three positions in space.
[[nodiscard]] double triangle_area(const double* a, const double* b, const double* c, double unit);

/// Whether twice the area is at most 1e-15 of the longest edge squared. The size of the
/// triangle does not matter: neither 1e300 nor 1e-200 is an alarm.
[[nodiscard]] bool has_no_area(const double* a, const double* b, const double* c, double unit);

}  // namespace timbre::detail
