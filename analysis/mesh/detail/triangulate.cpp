#include "timbre/analysis/mesh/detail/triangulate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <utility>

namespace timbre::detail {
namespace {

// Products of differences of doubles neither overflow in it, nor lose the sign of a turn
// that is more than rounding.
using Real = long double;

struct Vector3 {
  Real x, y, z;
};

Vector3 difference(const double* to, const double* from) {
  return {Real(to[0]) - from[0], Real(to[1]) - from[1], Real(to[2]) - from[2]};
}

Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Real length(const Vector3& a) { return std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z); }

// Twice the signed area: positive when a, b, c turn left.
Real turn(const Point2& a, const Point2& b, const Point2& c) {
  return (Real(b.x) - a.x) * (Real(c.y) - a.y) - (Real(b.y) - a.y) * (Real(c.x) - a.x);
}

// Projects along the coordinate axis nearest to the Newell normal, so that no coordinate
// is rounded, and so that the polygon turns left. Empty if it has no area.
void flatten(const double* coordinates, std::span<const std::int32_t> polygon,
             std::vector<Point2>& flat) {
  const auto position = [&](std::size_t i) {
    return coordinates + 3 * static_cast<std::size_t>(polygon[i]);
  };
  std::array<Real, 3> normal{};
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Vector3 n =
        cross(difference(position(i), position(0)), difference(position(i + 1), position(0)));
    normal[0] += n.x;
    normal[1] += n.y;
    normal[2] += n.z;
  }
  std::size_t axis = std::abs(normal[0]) > std::abs(normal[1]) ? 0 : 1;
  if (std::abs(normal[2]) >= std::abs(normal[axis])) axis = 2;
  flat.clear();
  if (normal[axis] == 0) return;
  const std::size_t right = (axis + (normal[axis] > 0 ? 1 : 2)) % 3;
  const std::size_t up = (axis + (normal[axis] > 0 ? 2 : 1)) % 3;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    flat.push_back({position(i)[right], position(i)[up]});
  }
}

bool goes_up(const Point2& from, const Point2& to) {
  return to.y > from.y || (to.y == from.y && to.x < from.x);
}

// Turns left at every corner and goes round once.
bool is_strictly_convex(const std::vector<Point2>& flat) {
  const std::size_t n = flat.size();
  int peaks = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Point2& before = flat[(i + n - 1) % n];
    const Point2& after = flat[(i + 1) % n];
    if (turn(before, flat[i], after) <= 0) return false;
    if (goes_up(before, flat[i]) && !goes_up(flat[i], after)) ++peaks;
  }
  return peaks == 1;
}

void fan(std::span<const std::int32_t> polygon, std::vector<std::int32_t>& triangles) {
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    triangles.insert(triangles.end(), {polygon[0], polygon[i], polygon[i + 1]});
  }
}

class EarClipper {
 public:
  EarClipper(const double* coordinates, std::span<const std::int32_t> polygon,
             const std::vector<Point2>& flat, std::int64_t& budget)
      : coordinates_(coordinates),
        polygon_(polygon),
        flat_(flat),
        budget_(budget),
        left_(polygon.size()),
        version_(left_, 0),
        blocker_place_(left_, kNone) {
    for (std::size_t i = 0; i < left_; ++i) {
      before_.push_back(i == 0 ? left_ - 1 : i - 1);
      after_.push_back(i + 1 == left_ ? 0 : i + 1);
    }
    for (std::size_t i = 0; i < left_; ++i) {
      if (turn_at(i) > 0) continue;
      blocker_place_[i] = blockers_.size();
      blockers_.push_back(i);
    }
    for (std::size_t i = 0; i < left_; ++i) consider(i);
  }

  void clip(std::vector<std::int32_t>& triangles) {
    while (left_ > 3 && !ears_.empty()) {
      const Ear ear = ears_.top();
      ears_.pop();
      if (ear.version == version_[ear.corner]) cut(ear.corner, triangles);
    }
    for (std::size_t i = after_[start_]; after_[i] != start_; i = after_[i]) {
      triangles.insert(triangles.end(), {polygon_[start_], polygon_[i], polygon_[after_[i]]});
    }
  }

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  struct Ear {
    double shape = 0.0;
    std::size_t corner = 0;
    int version = 0;
    bool operator<(const Ear& other) const {
      return shape != other.shape ? shape < other.shape : corner > other.corner;
    }
  };

  [[nodiscard]] const double* position(std::size_t i) const {
    return coordinates_ + 3 * static_cast<std::size_t>(polygon_[i]);
  }

  [[nodiscard]] Real turn_at(std::size_t i) const {
    return turn(flat_[before_[i]], flat_[i], flat_[after_[i]]);
  }

  // Whether no other corner lies in the triangle at i. Only one that does not turn left
  // can be the first to come in.
  bool is_free(std::size_t i) {
    const Point2& a = flat_[before_[i]];
    const Point2& b = flat_[i];
    const Point2& c = flat_[after_[i]];
    const auto x = std::minmax({a.x, b.x, c.x});
    const auto y = std::minmax({a.y, b.y, c.y});
    budget_ -= static_cast<std::int64_t>(blockers_.size());
    if (budget_ < 0) return false;
    return std::none_of(blockers_.begin(), blockers_.end(), [&](std::size_t k) {
      const Point2& p = flat_[k];
      return p.x >= x.first && p.x <= x.second && p.y >= y.first && p.y <= y.second && p != a &&
             p != b && p != c && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
    });
  }

  // The sine of the smallest angle at the ear: it lies opposite the shortest edge.
  [[nodiscard]] double shape(std::size_t i) const {
    const Vector3 u = difference(position(before_[i]), position(i));
    const Vector3 v = difference(position(after_[i]), position(i));
    std::array<Real, 3> edges = {length(u), length(v),
                                 length(difference(position(after_[i]), position(before_[i])))};
    std::sort(edges.begin(), edges.end());
    return edges[1] > 0 ? static_cast<double>(length(cross(u, v)) / edges[1] / edges[2]) : 0.0;
  }

  // Lines up the corner if it can be cut. A straight one always can: nothing is lost.
  void consider(std::size_t i) {
    ++version_[i];
    const Real turned = turn_at(i);
    if (turned == 0) {
      ears_.push({0.0, i, version_[i]});
    } else if (turned > 0 && is_free(i)) {
      ears_.push({shape(i), i, version_[i]});
    }
  }

  void stop_blocking(std::size_t i) {
    const std::size_t place = std::exchange(blocker_place_[i], kNone);
    if (place == kNone) return;
    blockers_[place] = blockers_.back();
    blockers_.pop_back();
    if (place < blockers_.size()) blocker_place_[blockers_[place]] = place;
  }

  void cut(std::size_t i, std::vector<std::int32_t>& triangles) {
    const std::size_t a = before_[i];
    const std::size_t c = after_[i];
    triangles.insert(triangles.end(), {polygon_[a], polygon_[i], polygon_[c]});
    after_[a] = c;
    before_[c] = a;
    start_ = a;
    --left_;
    stop_blocking(i);
    if (turn_at(a) > 0) stop_blocking(a);
    if (turn_at(c) > 0) stop_blocking(c);
    consider(a);
    consider(c);
  }

  const double* coordinates_;
  std::span<const std::int32_t> polygon_;
  const std::vector<Point2>& flat_;
  std::int64_t& budget_;
  std::size_t left_;                         // corners in the ring
  std::size_t start_ = 0;                    // one of them
  std::vector<std::size_t> before_, after_;  // the ring
  std::vector<int> version_;                 // of a corner's triangle; ears keep theirs
  std::vector<std::size_t> blockers_;        // corners of the ring that do not turn left
  std::vector<std::size_t> blocker_place_;   // where a corner stands in `blockers_`
  std::priority_queue<Ear> ears_;            // the best shaped on top
};

}  // namespace

bool Triangulator::split(std::span<const std::int32_t> polygon,
                         std::vector<std::int32_t>& triangles) {
  if (polygon.size() > 3) flatten(coordinates_.data(), polygon, flat_);
  if (polygon.size() == 3 || flat_.empty() || is_strictly_convex(flat_)) {
    fan(polygon, triangles);
    return true;
  }
  const bool had_budget = budget_ >= 0;
  EarClipper(coordinates_.data(), polygon, flat_, budget_).clip(triangles);
  return had_budget && budget_ >= 0;
}

}  // namespace timbre::detail
