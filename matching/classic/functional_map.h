#pragma once

#include "timbre/matching/refinement.h"
#include "timbre/matching/surface.h"

namespace timbre {

struct DescriptorMapOptions {
  int functions = 30;       ///< size of the first functional map; at least 3
  int energies = 100;       ///< columns of the wave kernel signature
  double laplacian = 0.01;  ///< how much commuting with the Laplacian counts
  int threads = 0;          ///< 0: all cores; the result does not depend on it
  Progress progress = {};
};

/// The usual functional map, to compare with: wave kernel signatures on both shapes, the map
/// that carries them over and commutes with the Laplacian, then ZoomOut.
///
/// Descriptors do not tell left from right, nor does anything after them: on a symmetric shape
/// the answer is one side or the other, or a mixture.
/// @return for each vertex of file A one of file B, -1 outside the largest component
/// @throws Error  bad_request for options below their least values
/// @see Ovsjanikov et al. 2012, sections 4 and 5; Aubry et al. 2011; Melzi et al. 2019
[[nodiscard]] PointMap match_by_descriptors(const MatchSurface& A, const MatchSurface& B,
                                            const DescriptorMapOptions& options = {});

}  // namespace timbre
