#pragma once

#include "timbre/matching/refinement.h"
#include "timbre/matching/surface.h"

namespace timbre {

/// What can be said of a map without knowing the truth. No single term is a safe judge:
/// a person's front taken for the back keeps geodesic distances as well as the truth does.
/// All are means of both directions, at unit area.
struct MapEnergies {
  double geodesic = 0.0;     ///< mean |d_A(x, y) - d_B(Tx, Ty)| over samples
  double bijectivity = 0.0;  ///< mean distance from x to its image there and back
  double coverage = 0.0;     ///< share of the samples that are hit
  double commutation = 0.0;  ///< how far C is from commuting with the Laplacians
  double stretch = 0.0;      ///< mean change of short Euclidean distances, over their range
  double curvature = 0.0;    ///< correlation of mean curvature carried over
  double products = 0.0;     ///< correlation of the product tensors on 15 functions
  double areas = 0.0;        ///< of the area forms: +1 keeps orientation, -1 mirrors
};

[[nodiscard]] MapEnergies measure_energies(const MatchSurface& A, const MatchSurface& B,
                                           const SampledMaps& maps);

/// First score, on samples; small is good. Weights from logged candidates of isometric
/// sets: the sum is right in 92 to 95 % where the best single term reaches 97 on one set
/// and 87 on another.
[[nodiscard]] double sample_score(const MapEnergies& e, int orientation);

/// Mean correlation of the mean curvature in bands of higher frequency, both ways. It
/// tells a front from a back when everything intrinsic agrees.
[[nodiscard]] double curvature_bands(const MatchSurface& A, const MatchSurface& B,
                                     const FunctionalMaps& maps);

/// ||C o (lambda_A 1^T - 1 lambda_B^T)|| / ||lambda_A|| on the leading `size` functions.
[[nodiscard]] double commutation_error(const MatchSurface& A, const MatchSurface& B,
                                       const Eigen::MatrixXd& C, Eigen::Index size);

/// Score of dense maps; small is good. Separates what samples could not.
[[nodiscard]] double dense_score(const MatchSurface& A, const MatchSurface& B,
                                 const DenseMaps& maps, int orientation);

/// Share of B's area that the map hits, by vertex masses.
[[nodiscard]] double covered_area(const MatchSurface& B, const PointMap& ab);

/// Mean geodesic distance on B between two maps of A's samples, by sample mass.
[[nodiscard]] double map_distance(const MatchSurface& A, const MatchSurface& B, const PointMap& S,
                                  const PointMap& T);

}  // namespace timbre
