#pragma once

#include <cstdint>

#include "timbre/analysis/operators/detail/tufted_cover.h"

namespace timbre::detail {

/// Flips edges until the two angles opposite each sum to at most pi. Vertices and the metric
/// stay; triangles and edges change. Edges of one triangle (on a boundary, or with the same one
/// on both sides) stay.
///
/// @return the number of flips
/// @throws Error  not_converged if flips do not settle; in exact arithmetic they do
/// @see Bobenko and Springborn 2007; Fisher, Springborn, Bobenko and Schroeder 2006
std::int64_t make_delaunay(IntrinsicTriangulation& triangulation);

/// Cotangents of the angle opposite each halfedge.
[[nodiscard]] std::vector<double> opposite_cotangents(const IntrinsicTriangulation& triangulation);

}  // namespace timbre::detail
