#include "timbre/analysis/mesh/sides.h"

#include <algorithm>
#include <tuple>

namespace timbre {

std::vector<TriangleSide> sorted_sides(const Faces& faces) {
  std::vector<TriangleSide> sides;
  sides.reserve(static_cast<std::size_t>(3 * faces.rows()));
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    if (faces(f, 0) == faces(f, 1) || faces(f, 1) == faces(f, 2) || faces(f, 2) == faces(f, 0)) {
      continue;
    }
    for (int c = 0; c < 3; ++c) {
      const std::int32_t a = faces(f, c);
      const std::int32_t b = faces(f, (c + 1) % 3);
      sides.push_back({std::min(a, b), std::max(a, b), faces(f, (c + 2) % 3),
                       static_cast<std::int32_t>(f), a < b});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const TriangleSide& a, const TriangleSide& b) {
    return std::tie(a.low, a.high, a.apex, a.face) < std::tie(b.low, b.high, b.apex, b.face);
  });
  return sides;
}

std::size_t end_of_edge(const std::vector<TriangleSide>& sides, std::size_t begin) {
  std::size_t end = begin;
  while (end < sides.size() && sides[end].low == sides[begin].low &&
         sides[end].high == sides[begin].high) {
    ++end;
  }
  return end;
}

}  // namespace timbre
