#include "timbre/analysis/operators/detail/robust.h"

#include <algorithm>
#include <utility>

#include "timbre/analysis/operators/detail/intrinsic_delaunay.h"
#include "timbre/analysis/operators/detail/tufted_cover.h"

namespace timbre::detail {
namespace {

// An obtuse angle opposite a boundary edge: in the cover, which has the triangle on both sides,
// that edge could be flipped.
bool has_obtuse_boundary(const IntrinsicTriangulation& t, const std::vector<double>& cotangent) {
  for (std::size_t h = 0; h < t.twin.size(); ++h) {
    if (t.twin[h] < 0 && cotangent[h] < 0.0) return true;
  }
  return false;
}

std::vector<MatrixPair> edge_weights(const IntrinsicTriangulation& t,
                                     const std::vector<double>& cotangent) {
  std::vector<MatrixPair> weights;
  weights.reserve(t.tail.size() / 2);
  for (std::size_t h = 0; h < t.tail.size(); ++h) {
    const std::int32_t twin = t.twin[h];
    if (twin >= 0 && static_cast<std::size_t>(twin) < h) continue;
    const double sum = cotangent[h] + (twin < 0 ? 0.0 : cotangent[static_cast<std::size_t>(twin)]);
    const std::size_t next = h % 3 == 2 ? h - 2 : h + 1;
    // Below 0 by rounding only.
    weights.push_back({t.tail[h], t.tail[next], 0.5 * t.share * std::max(sum, 0.0)});
  }
  return weights;
}

std::vector<MetricFace> metric_faces(const IntrinsicTriangulation& t) {
  std::vector<MetricFace> faces;
  faces.reserve(t.tail.size() / 3);
  for (std::size_t h = 0; h < t.tail.size(); h += 3) {
    faces.push_back({{t.tail[h], t.tail[h + 1], t.tail[h + 2]},
                     {t.length[h + 1], t.length[h + 2], t.length[h]}});
  }
  return faces;
}

}  // namespace

DelaunayElements delaunay_elements(const Surface& surface, const Points* positions) {
  DelaunayElements found;
  IntrinsicTriangulation t = oriented_sheet(surface);
  std::vector<double> cotangent;
  if (!t.tail.empty()) {
    found.flips = make_delaunay(t);
    cotangent = opposite_cotangents(t);
  }
  if (t.tail.empty() || has_obtuse_boundary(t, cotangent)) {
    t = tufted_cover(surface, positions);
    found.flips = make_delaunay(t);
    cotangent = opposite_cotangents(t);
  }
  found.weights = edge_weights(t, cotangent);
  found.faces = metric_faces(t);
  found.share = t.share;
  return found;
}

}  // namespace timbre::detail
