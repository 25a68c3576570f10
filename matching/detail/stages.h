#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/matching/selection.h"

namespace timbre::detail {

// The stages that matching and symmetry have in common.

inline constexpr std::array kSampleSizes = {20, 24, 28, 32, 36, 40, 45, 50};
inline constexpr std::array kVertexSizes = {50, 60, 72, 86, 100};
inline constexpr int kVertexSamples = 800;
inline constexpr double kDistinct = 0.06;  ///< mean distance of maps that are different answers

/// The first `wanted` rivals of which no two are nearly the same map.
/// @param rivals  best first; a rival's map between samples is `rival->sampled.points.ab`
template <typename Rival>
std::vector<Rival> first_distinct(const MatchSurface& A, const MatchSurface& B,
                                  const std::vector<Rival*>& rivals, int wanted) {
  std::vector<Rival> distinct;
  for (Rival* rival : rivals) {
    const bool is_new = std::all_of(distinct.begin(), distinct.end(), [&](const Rival& other) {
      return map_distance(A, B, rival->sampled.points.ab, other.sampled.points.ab) > kDistinct;
    });
    if (is_new) distinct.push_back(*rival);
    if (static_cast<int>(distinct.size()) == wanted) break;
  }
  return distinct;
}

/// @throws Error  bad_request unless value >= least
inline void require_at_least(const char* option, int value, int least) {
  if (value >= least) return;
  throw Error(ErrorKind::bad_request, "", option,
              "is " + std::to_string(value) + "; at least " + std::to_string(least) + " is needed");
}

}  // namespace timbre::detail
