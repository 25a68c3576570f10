#pragma once

#include "timbre/matching/refinement.h"
#include "timbre/matching/surface.h"

namespace timbre {

/// A surface in another's pose.
struct PosedSurface {
  Points points;   ///< n x 3
  Points normals;  ///< n x 3
};

/// A in the pose of B: the smooth part of the map's image, by A's first `size`
/// eigenfunctions, with A's detail carried along by local rotations.
///
/// @param ab           a row of B for each row of A
/// @param orientation  -1: local rotations are reflections (a mirrored map)
[[nodiscard]] PosedSurface pose_as(const MatchSurface& A, const MatchSurface& B, const PointMap& ab,
                                   Eigen::Index size, int orientation);

/// Root mean square distance between A posed as B and the map's image, at unit area.
[[nodiscard]] double pose_residual(const MatchSurface& A, const MatchSurface& B, const PointMap& ab,
                                   Eigen::Index size, int orientation);

}  // namespace timbre
