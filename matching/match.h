#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "timbre/analysis/core/progress.h"
#include "timbre/matching/refinement.h"
#include "timbre/matching/selection.h"
#include "timbre/matching/surface.h"
#include "timbre/matching/switches.h"

namespace timbre {

enum class Verdict : std::uint8_t {
  clear,      ///< one solution stands out
  ambiguous,  ///< another solution is nearly as good, or left and right cannot be told
  failed,     ///< no solution looks like a map between these two shapes
};

enum class MapOrientation : std::uint8_t {
  direct,    ///< keeps orientation, as a change of pose does
  mirrored,  ///< turns left into right
  unknown,   ///< a shape is too open to have an inside, or one-sided
};

/// One answer among several, best first.
struct MatchSolution {
  /// Small is good; comparable within one match only. Between two-sided shapes 2 is added to
  /// a mirrored map: poses of a left-right symmetric body fit it as well as the right one.
  double energy = 0.0;
  MapOrientation orientation = MapOrientation::unknown;
  double coverage = 0.0;    ///< share of both areas that is hit
  double confidence = 0.0;  ///< share among the solutions by energy; not calibrated
  MapEnergies energies;     ///< on samples
  FunctionalMaps functional;
};

struct MatchTimings {
  double search = 0.0, samples = 0.0, vertices = 0.0, dense = 0.0;  ///< seconds
};

struct MatchResult {
  Verdict verdict = Verdict::failed;
  std::string reason;  ///< why the verdict is not `clear`; empty if it is
  std::vector<MatchSolution> solutions;
  std::vector<Switch> switches;  ///< of the best solution, first 20 functions
  PointMap ab;  ///< best solution: for each vertex of file A one of file B, -1 = unmatched
  PointMap ba;
  MatchTimings timings;
};

struct MatchOptions {
  int candidates = 12;  ///< taken from the search, of each orientation
  int rivals = 4;       ///< distinct maps that are refined and compared
  int threads = 0;      ///< 0: all cores; the result does not depend on it
  Progress progress = {};
};

/// Maps two nearly isometric surfaces onto each other, and says how sure it is.
///
/// Every sign and order of the low eigenfunctions is a hypothesis (`search_candidates`),
/// in both orientations; the candidates are refined on samples and compared by several
/// energies, the best distinct ones again on all vertices, close rivals once more after
/// dense refinement. Where both shapes have two sides the answer keeps orientation, unless
/// a mirrored map is better by far; the best mirrored map stands among the solutions. On
/// open shapes the sides are taken from the order of the faces' corners, and doubted.
///
/// Vertices outside the largest component, or in no triangle, are unmatched (-1).
/// @throws Error  bad_request unless `candidates` and `rivals` are at least 1; cancelled
[[nodiscard]] MatchResult match(const MatchSurface& A, const MatchSurface& B,
                                const MatchOptions& options = {});

[[nodiscard]] const char* to_word(Verdict verdict);
[[nodiscard]] const char* to_word(MapOrientation orientation);

}  // namespace timbre
