#pragma once

#include <Eigen/Core>
#include <vector>

#include "timbre/analysis/core/progress.h"
#include "timbre/matching/refinement.h"
#include "timbre/matching/selection.h"
#include "timbre/matching/surface.h"

namespace timbre {

/// An intrinsic reflection of a shape: a self-map that turns orientation and, done
/// twice, leads back.
struct Reflection {
  PointMap map;               ///< file vertex -> file vertex, -1 = unmatched
  Eigen::MatrixXd C;          ///< symmetric functional map of the eigenfunctions
  double energy = 0.0;        ///< small is good; comparable within one shape only
  double confidence = 0.0;    ///< share among the reflections by energy; not calibrated
  double displacement = 0.0;  ///< mean distance from x to its image, at unit area
  double involution = 0.0;    ///< mean distance from x to its image's image, at unit area
  MapEnergies energies;       ///< on samples
};

struct SymmetryOptions {
  int candidates = 20;  ///< taken from the search
  int rivals = 6;       ///< distinct maps that are refined and compared
  int threads = 0;      ///< 0: all cores; the result does not depend on it
  Progress progress = {};
};

/// The reflections of a shape, best first; empty if it has none. The engine of `match`,
/// from a shape to itself with orientation reversed, so that the identity cannot appear,
/// and with a functional map that is kept symmetric.
/// @throws Error  bad_request unless `candidates` and `rivals` are at least 1; cancelled
/// @see Ovsjanikov, Sun and Guibas 2008; Ren et al. 2018
[[nodiscard]] std::vector<Reflection> find_reflections(const MatchSurface& shape,
                                                       const SymmetryOptions& options = {});

}  // namespace timbre
