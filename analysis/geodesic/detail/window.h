#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace timbre::detail {

/// A stretch of an edge that is seen along straight lines from one point: the (pseudo-)source
/// laid into the plane of the edge, behind the triangle it is seen through.
/// The edge lies on the x axis, from its smaller vertex at 0; y > 0 is the side of the source.
struct Window {
  double begin = 0.0;
  double end = 0.0;
  double x = 0.0;
  double y = 0.0;
  double base = 0.0;      ///< distance of the pseudo-source itself
  std::int32_t side = 0;  ///< the triangle it comes through, as a side of the mesh

  [[nodiscard]] double distance_at(double position) const {
    const double along = position - x;
    return base + std::sqrt(along * along + y * y);
  }
  /// Of its nearest point.
  [[nodiscard]] double nearest() const {
    return distance_at(x < begin ? begin : (x > end ? end : x));
  }
};

/// Parts of a stretch that fall to either of two windows; at most three.
struct Contest {
  int parts = 0;
  std::array<double, 4> cut{};  ///< part i is [cut[i], cut[i + 1]]
  std::array<bool, 3> first{};  ///< whether it falls to the first window
};

/// Parts [begin, end] between two windows of one edge that both cover it. The first window gets
/// a part if it is nearer by more than `tie`; parts narrower than `least` join their neighbour.
[[nodiscard]] Contest contest(const Window& first, const Window& second, double begin, double end,
                              double least, double tie);

/// An edge met from a corner of a triangle that a window's rays have entered by another edge.
struct Crossing {
  double x = 0.0;  ///< the source, from the corner along the edge of entry
  double y = 0.0;
  double apex_x = 0.0;  ///< the far end of the edge that is met
  double apex_y = 0.0;
  double split = 0.0;  ///< where the ray to the apex enters
  double begin = 0.0;  ///< the window, from the corner; begin < split
  double end = 0.0;
};

/// What the window shows of the edge from the corner to the apex, of this `length` > 0; positions
/// count from the corner. `base` and `side` are left as they are.
void see_through(const Crossing& crossing, double length, Window& window);

}  // namespace timbre::detail
