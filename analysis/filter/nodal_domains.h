#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre {

/// The regions of one sign of a function, joined along edges. For a function that is linear on each
/// triangle the strong ones are exactly the connected parts of the surface where it is positive, or
/// negative: two such corners of a triangle share an edge. Where nodal lines cross within
/// a triangle or an edge, two of the four regions are therefore joined.
struct NodalDomains {
  /// n, the strong domain of each vertex, numbered by their first vertices; -1 where the function
  /// counts as zero.
  std::vector<std::int32_t> label;
  std::int32_t count = 0;  ///< strong domains: zeros belong to none, and part
  /// Weak domains: zeros belong to both signs, and join; those of zeros only do not count.
  std::int32_t weak_count = 0;
};

/// Finds them. Courant's theorem: eigenfunction i of a connected surface, counted from 0, has at
/// most i + 1. Of matrices with weights of 0 or more, as `robust` with a diagonal mass, on their
/// own edges: at most i + 1 weak domains, and at most i + r strong ones, where lambda_i is r-fold
/// and i its first index (Davies, Gladwell, Leydold and Stadler 2001, theorems 1 and 2).
///
/// @param function  n, one value for each vertex
/// @param zero      values of at most this share of the largest size count as zero: on a nodal line
///                  along vertices an eigenfunction is rounding, of either sign
/// @throws Error  bad_request if there is not one value for each corner, or `zero` is negative
[[nodiscard]] NodalDomains find_nodal_domains(const Faces& faces, const Eigen::VectorXd& function,
                                              double zero = 1e-8);

}  // namespace timbre
