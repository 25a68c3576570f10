#include "timbre/analysis/mesh/sides.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <tuple>

namespace timbre {

std::vector<TriangleSide> sorted_sides(const Faces& faces) {
  const auto at = [](std::int32_t index) { return static_cast<std::size_t>(index); };
  const auto for_each_side = [&](const auto& visit) {
    for (Eigen::Index f = 0; f < faces.rows(); ++f) {
      const auto [a, b, c] = std::array{faces(f, 0), faces(f, 1), faces(f, 2)};
      if (a == b || b == c || c == a) continue;
      const auto face = static_cast<std::int32_t>(f);
      visit(TriangleSide{std::min(a, b), std::max(a, b), c, face, a < b});
      visit(TriangleSide{std::min(b, c), std::max(b, c), a, face, b < c});
      visit(TriangleSide{std::min(c, a), std::max(c, a), b, face, c < a});
    }
  };
  // By the smaller vertex first: few sides have the same, and they fit into a cache.
  const std::int32_t vertices = faces.size() > 0 ? faces.maxCoeff() + 1 : 0;
  std::vector<std::size_t> begin(at(vertices) + 1, 0);
  for_each_side([&](const TriangleSide& side) { ++begin[at(side.low) + 1]; });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<TriangleSide> sides(begin.back());
  std::vector<std::size_t> next = begin;
  for_each_side([&](const TriangleSide& side) { sides[next[at(side.low)]++] = side; });
  for (std::size_t v = 0; v + 1 < begin.size(); ++v) {
    std::sort(sides.begin() + static_cast<std::ptrdiff_t>(begin[v]),
              sides.begin() + static_cast<std::ptrdiff_t>(begin[v + 1]),
              [](const TriangleSide& a, const TriangleSide& b) {
                return std::tie(a.high, a.apex, a.face) < std::tie(b.high, b.apex, b.face);
              });
  }
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
