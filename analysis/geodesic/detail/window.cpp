#include "timbre/analysis/geodesic/detail/window.h"

#include <algorithm>
#include <utility>

namespace timbre::detail {
namespace {

struct Roots {
  int count = 0;
  std::array<double, 2> at{};
};

// Where |p - first| + first.base = |p - second| + second.base may hold on the edge: squared
// twice, which adds false roots but loses none.
Roots equal_distances(const Window& first, const Window& second) {
  const double apart = first.x - second.x;
  const double lead = second.base - first.base;
  // With t = position - second.x:  constant - 2 apart t = 2 lead |p - second|.
  const double constant = apart * apart + (first.y - second.y) * (first.y + second.y) - lead * lead;
  const double a = 4.0 * (apart - lead) * (apart + lead);
  const double half_b = -2.0 * apart * constant;
  const double c = (constant - 2.0 * lead * second.y) * (constant + 2.0 * lead * second.y);
  // A double root, as when the bases are equal, may come out a little below 0.
  const double square = half_b * half_b;
  const double discriminant = square - a * c;
  Roots roots;
  if (!(discriminant >= -1e-12 * square)) return roots;
  const double q = -(half_b + std::copysign(std::sqrt(std::max(discriminant, 0.0)), half_b));
  if (a != 0.0) roots.at[static_cast<std::size_t>(roots.count++)] = q / a + second.x;
  if (q != 0.0) roots.at[static_cast<std::size_t>(roots.count++)] = c / q + second.x;
  if (roots.count == 2 && roots.at[0] > roots.at[1]) std::swap(roots.at[0], roots.at[1]);
  return roots;
}

}  // namespace

Contest contest(const Window& first, const Window& second, double begin, double end, double least,
                double tie) {
  Contest result;
  result.cut[0] = begin;
  const Roots roots = equal_distances(first, second);
  const auto close_part = [&](double to) {
    const auto part = static_cast<std::size_t>(result.parts);
    const double middle = 0.5 * (result.cut[part] + to);
    const bool wins = first.distance_at(middle) < second.distance_at(middle) - tie;
    if (part > 0 && result.first[part - 1] == wins) {
      result.cut[part] = to;
      return;
    }
    result.first[part] = wins;
    result.cut[part + 1] = to;
    ++result.parts;
  };
  for (int i = 0; i < roots.count; ++i) {
    const double root = roots.at[static_cast<std::size_t>(i)];
    const double last = result.cut[static_cast<std::size_t>(result.parts)];
    if (root - last > least && end - root > least) close_part(root);
  }
  close_part(end);
  return result;
}

// All terms of the denominator are sums of positive ones, also where the triangle has no area.
void see_through(const Crossing& c, double length, Window& window) {
  const auto reach = [&c](double position) {
    return position * c.y / (c.y * c.split + c.apex_y * (c.split - position));
  };
  window.begin = length * std::min(reach(c.begin), 1.0);
  window.end = c.end < c.split ? length * std::min(reach(c.end), 1.0) : length;
  window.x = (c.x * c.apex_x - c.y * c.apex_y) / length;
  window.y = c.split * (c.y + c.apex_y) / length;
}

}  // namespace timbre::detail
