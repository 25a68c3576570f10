// Polygons: n - 2 triangles of their corners, whatever they are; a simple polygon in a plane is
// tiled by them exactly.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "timbre/analysis/mesh/detail/triangulate.h"
#include "timbre/tests/fuzz/target.h"

namespace timbre::fuzz {
namespace {

struct Lattice {
  std::int64_t x = 0, y = 0;
  friend bool operator==(const Lattice&, const Lattice&) = default;
};

// Twice the signed area, exact.
std::int64_t turn(const Lattice& a, const Lattice& b, const Lattice& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool is_between(const Lattice& a, const Lattice& p, const Lattice& b) {
  return turn(a, b, p) == 0 && std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) &&
         std::min(a.y, b.y) <= p.y && p.y <= std::max(a.y, b.y);
}

int sign(std::int64_t value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

bool touch(const Lattice& a, const Lattice& b, const Lattice& c, const Lattice& d) {
  if (is_between(a, c, b) || is_between(a, d, b) || is_between(c, a, d) || is_between(c, b, d)) {
    return true;
  }
  return sign(turn(a, b, c)) * sign(turn(a, b, d)) < 0 &&
         sign(turn(c, d, a)) * sign(turn(c, d, b)) < 0;
}

// No two edges meet but neighbours, and they only in their common corner.
bool is_simple(const std::vector<Lattice>& polygon) {
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Lattice& a = polygon[i];
    const Lattice& b = polygon[(i + 1) % n];
    const Lattice& c = polygon[(i + 2) % n];
    if (a == b || is_between(a, c, b) || is_between(b, a, c)) return false;
    for (std::size_t j = i + 2; j < n; ++j) {
      const std::size_t next = (j + 1) % n;
      if (next != i && touch(a, b, polygon[j], polygon[next])) return false;
    }
  }
  return true;
}

std::vector<std::int32_t> split(const std::vector<double>& coordinates,
                                const std::vector<std::int32_t>& polygon) {
  std::vector<std::int32_t> triangles;
  require(detail::Triangulator(coordinates).split(polygon, triangles), "little work is enough");
  require(triangles.size() == 3 * (polygon.size() - 2), "n corners make n - 2 triangles");
  for (const std::int32_t corner : triangles) {
    require(std::find(polygon.begin(), polygon.end(), corner) != polygon.end(),
            "triangles have corners of the polygon");
  }
  return triangles;
}

void require_tiled(const std::vector<Lattice>& points, const std::vector<std::int32_t>& triangles) {
  std::int64_t whole = 0;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    whole += turn(points[0], points[i], points[i + 1]);
  }
  std::int64_t sum = 0;
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    const auto corner = [&](std::size_t k) {
      return points[static_cast<std::size_t>(triangles[t + k])];
    };
    const std::int64_t area = turn(corner(0), corner(1), corner(2));
    require(sign(area) * sign(whole) >= 0, "triangles are turned as the polygon");
    sum += area;
  }
  require(sum == whole, "areas add up");
}

// A simple polygon of the input's points, each put between two corners where that does no harm;
// fewer than three if there are not enough.
std::vector<Lattice> grown_polygon(Draw& draw) {
  std::vector<Lattice> polygon;
  for (int trial = 0; trial < 60 && !draw.empty(); ++trial) {
    const std::size_t place = draw.below(polygon.size() + 1);
    const Lattice point{draw.take<std::int8_t>(), draw.take<std::int8_t>()};
    std::vector<Lattice> longer = polygon;
    longer.insert(longer.begin() + static_cast<std::ptrdiff_t>(place), point);
    if (longer.size() < 3 || is_simple(longer)) polygon = std::move(longer);
  }
  return polygon;
}

std::vector<Lattice> polygon_as_it_stands(Draw& draw) {
  std::vector<Lattice> polygon;
  while (!draw.empty() && polygon.size() < 100) {
    const auto x = draw.take<std::int8_t>();
    polygon.push_back({x, draw.take<std::int8_t>()});
  }
  return polygon;
}

// On small integers in a tilted plane, where all is exact.
void examine_flat(Draw draw, bool grow) {
  const std::size_t axis = draw.below(3);
  const auto tilt_x = static_cast<double>(draw.take<std::int8_t>() / 16);
  const auto tilt_y = static_cast<double>(draw.take<std::int8_t>() / 16);
  const double unit = std::ldexp(1.0, 4 * draw.take<std::int8_t>());
  const std::vector<Lattice> points = grow ? grown_polygon(draw) : polygon_as_it_stands(draw);
  if (points.size() < 3) return;
  std::vector<double> coordinates;
  for (const Lattice& p : points) {
    const auto x = static_cast<double>(p.x);
    const auto y = static_cast<double>(p.y);
    std::array<double, 3> xyz{};
    xyz[axis] = (x * tilt_x + y * tilt_y) * unit;
    xyz[(axis + 1) % 3] = x * unit;
    xyz[(axis + 2) % 3] = y * unit;
    coordinates.insert(coordinates.end(), xyz.begin(), xyz.end());
  }
  std::vector<std::int32_t> corners(points.size());
  std::iota(corners.begin(), corners.end(), 0);
  const std::vector<std::int32_t> triangles = split(coordinates, corners);
  if (is_simple(points)) require_tiled(points, triangles);
}

// Doubles of any bits, corners that come again.
void examine_wild(Draw draw) {
  std::vector<double> coordinates(3 * (1 + draw.below(12)));
  for (double& c : coordinates) {
    c = draw.take<double>();
    if (!std::isfinite(c)) c = 1.0;
  }
  std::vector<std::int32_t> corners;
  while (!draw.empty() && corners.size() < 100) {
    corners.push_back(static_cast<std::int32_t>(draw.below(coordinates.size() / 3)));
  }
  if (corners.size() >= 3) (void)split(coordinates, corners);
}

}  // namespace

void examine(std::string_view input) {
  Draw draw(input);
  const std::size_t way = draw.below(3);
  way == 1 ? examine_wild(draw) : examine_flat(draw, way == 2);
}

}  // namespace timbre::fuzz
