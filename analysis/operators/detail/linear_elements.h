#pragma once

#include <Eigen/Core>
#include <vector>

#include "timbre/analysis/operators/detail/surface.h"
#include "timbre/analysis/operators/detail/symmetric_matrix.h"

namespace timbre::detail {

// What piecewise linear functions on triangles need. Triangles are faces of a surface, or others
// on the same vertices; masses are in squares of the mesh's unit of length.

/// Half the cotangent of each angle, for the edge it lies opposite to (Pinkall and Polthier 1993).
[[nodiscard]] std::vector<MatrixPair> cotangent_weights(const std::vector<MetricFace>& faces);

/// A third of each triangle to each corner.
[[nodiscard]] Eigen::VectorXd barycentric_areas(const Surface& surface,
                                                const std::vector<MetricFace>& faces);

/// The part of each triangle that is nearest to a corner, found by circumcentres; of an obtuse
/// triangle half to the obtuse corner and a quarter to the others, so that no area is negative.
/// @see Meyer, Desbrun, Schroeder and Barr 2003, section 3.3 (mixed cells)
[[nodiscard]] Eigen::VectorXd circumcentric_areas(const Surface& surface,
                                                  const std::vector<MetricFace>& faces);

/// The Galerkin mass without its diagonal, which is half the barycentric area of each vertex.
[[nodiscard]] std::vector<MatrixPair> galerkin_pairs(const Surface& surface,
                                                     const std::vector<MetricFace>& faces);

/// Area in squares of the mesh's unit of length.
[[nodiscard]] double true_area(const Surface& surface, const MetricFace& face);

}  // namespace timbre::detail
