#pragma once

#include <Eigen/Core>

namespace timbre {

struct DistanceQuantilesOptions {
  int samples = 500;   ///< vertices drawn; all pairs of them are measured; at least 2
  int quantiles = 64;  ///< entries of the descriptor, at least 1
};

/// Quantiles of the distances between pairs of points of an embedded surface, the
/// points spread evenly by area: entry q is the (q + 1/2) / quantiles quantile.
///
/// Vertices are drawn systematically, at equal steps of area along the order of their
/// distance from the origin: no chance, and no dependence on the order of vertices
/// beyond ties (mirrored vertices), signs of coordinates or rotations.
///
/// @param coordinates  n x d, as `compute_embedding` makes them
/// @param masses       n, area around each vertex; vertices without area are not drawn
/// @throws Error  bad_request if sizes differ, options are out of range or no vertex has area
/// @see Rustamov 2007 (GPS embedding and histograms of its distances)
[[nodiscard]] Eigen::VectorXd compute_distance_quantiles(
    const Eigen::MatrixXd& coordinates, const Eigen::VectorXd& masses,
    const DistanceQuantilesOptions& options = {});

}  // namespace timbre
