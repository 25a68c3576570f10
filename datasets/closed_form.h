#pragma once

#include <vector>

namespace timbre {

// The lowest `count` eigenvalues of the surfaces of `analytic.h`, each as often as it occurs,
// in ascending order. Open surfaces have Neumann boundaries. Units: 1 / length^2.
// Less than 1 throws Error (bad_request).

/// l (l + 1), each 2 l + 1 times.
[[nodiscard]] std::vector<double> sphere_eigenvalues(int count);

/// pi^2 (i^2 / width^2 + j^2 / height^2).
[[nodiscard]] std::vector<double> rectangle_eigenvalues(double width, double height, int count);

/// Squares of the zeros of the derivatives of Bessel functions, twice from order 1 on.
/// @see Courant and Hilbert 1953, chapter V
[[nodiscard]] std::vector<double> disk_eigenvalues(int count);

/// m^2 + (pi j / height)^2, twice where m > 0.
[[nodiscard]] std::vector<double> cylinder_eigenvalues(double height, int count);

/// 4 pi^2 (i^2 + j^2) over all integers i and j, for side 1.
[[nodiscard]] std::vector<double> flat_torus_eigenvalues(int count);

}  // namespace timbre
