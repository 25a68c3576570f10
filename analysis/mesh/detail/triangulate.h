#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace timbre::detail {

struct Point2 {
  double x, y;
  friend bool operator==(const Point2&, const Point2&) = default;
};

/// Splits polygons into triangles that keep their orientation.
///
/// A convex polygon becomes a fan from its first corner. Any other loses ears in the plane
/// of its Newell normal, the best shaped first. Self-crossing polygons have no right
/// answer: when no ear is left, the rest becomes a fan.
class Triangulator {
 public:
  /// @param coordinates  x y z of each vertex, finite; borrowed
  explicit Triangulator(std::span<const double> coordinates) : coordinates_(coordinates) {}

  /// Appends three vertex numbers for each of n - 2 triangles.
  ///
  /// @param polygon  n >= 3 vertex numbers
  /// @return false if the polygon asked for too much work and the rest of it became a fan
  ///         unexamined: that takes more than 10,000 corners, thousands of them reflex
  bool split(std::span<const std::int32_t> polygon, std::vector<std::int32_t>& triangles);

 private:
  std::span<const double> coordinates_;
  std::vector<Point2> flat_;           // the polygon at hand, in its plane
  std::int64_t budget_ = 200'000'000;  // tests of a corner against an ear, for all polygons
};

}  // namespace timbre::detail
