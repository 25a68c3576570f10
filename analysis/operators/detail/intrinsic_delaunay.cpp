#include "timbre/analysis/operators/detail/intrinsic_delaunay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "timbre/analysis/core/error.h"

namespace timbre::detail {
namespace {

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

constexpr std::int32_t next(std::int32_t h) { return h - h % 3 + (h + 1) % 3; }
constexpr std::int32_t previous(std::int32_t h) { return h - h % 3 + (h + 2) % 3; }

// Rounding can leave no area of a needle; its cotangents are then huge, but numbers.
double area_of(const std::array<double, 3>& length) {
  const double longest = *std::max_element(length.begin(), length.end());
  return std::max(triangle_area(length), 1e-16 * longest * longest);
}

// Of the triangle whose first halfedge this is; the angle of each lies opposite its halfedge.
std::array<double, 3> cotangents_of(const IntrinsicTriangulation& t, std::size_t first) {
  const std::array<double, 3> length = {t.length[first], t.length[first + 1], t.length[first + 2]};
  return cotangents(length, area_of(length));
}

class Flipper {
 public:
  explicit Flipper(IntrinsicTriangulation& t) : t_(t), cotangent_(opposite_cotangents(t)) {}

  std::int64_t run() {
    for (std::int32_t h = 0; h < halfedges(); ++h) {
      if (h < t_.twin[at(h)]) push_if_bad(h);
    }
    // Fewer than one flip a triangle is usual, whatever the mesh.
    const std::int64_t most = 50 * static_cast<std::int64_t>(t_.tail.size());
    std::int64_t flips = 0;
    while (!stack_.empty()) {
      const std::int32_t h = stack_.back();
      stack_.pop_back();
      if (!is_bad(h)) continue;
      if (++flips > most) {
        throw Error(ErrorKind::not_converged, "", "operator", "intrinsic edge flips do not settle");
      }
      flip(h);
    }
    return flips;
  }

 private:
  [[nodiscard]] std::int32_t halfedges() const { return static_cast<std::int32_t>(t_.tail.size()); }

  // A triangle on both sides of an edge has two angles there that sum to less than pi.
  [[nodiscard]] bool is_bad(std::int32_t h) const {
    const std::int32_t twin = t_.twin[at(h)];
    if (twin < 0 || h / 3 == twin / 3) return false;
    const double a = cotangent_[at(h)];
    const double b = cotangent_[at(twin)];
    return a + b < -1e-12 * (1.0 + std::abs(a) + std::abs(b));
  }

  void push_if_bad(std::int32_t h) {
    if (is_bad(h)) stack_.push_back(h);
  }

  void update_cotangents(std::int32_t face) {
    const std::array<double, 3> cotangent = cotangents_of(t_, at(3 * face));
    std::copy(cotangent.begin(), cotangent.end(),
              cotangent_.begin() + static_cast<std::ptrdiff_t>(3) * face);
  }

  // Distance of the two corners off edge h, with both triangles laid into the plane.
  [[nodiscard]] double diagonal(std::int32_t h, std::int32_t twin) const {
    const double base = t_.length[at(h)];
    const auto corner = [&](double from_start, double from_end) {
      const double x = 0.5 * (base + (from_start - from_end) * (from_start + from_end) / base);
      return std::array{x, 2.0 * area_of({base, from_start, from_end}) / base};
    };
    const auto [x1, y1] = corner(t_.length[at(previous(h))], t_.length[at(next(h))]);
    const auto [x2, y2] = corner(t_.length[at(next(twin))], t_.length[at(previous(twin))]);
    return std::hypot(x1 - x2, y1 + y2);
  }

  // Corners i, j, k of h's triangle and j, i, l of its twin's become k, i, l and l, j, k.
  void flip(std::int32_t h) {
    const std::int32_t twin = t_.twin[at(h)];
    const std::int32_t f = 3 * (h / 3);
    const std::int32_t g = 3 * (twin / 3);
    const double length = diagonal(h, twin);
    // The outer halfedges jk, ki, il, lj move; an outer partner may be one of the four itself.
    const std::array<std::int32_t, 4> from = {next(h), previous(h), next(twin), previous(twin)};
    const std::array<std::int32_t, 4> to = {g + 1, f, f + 1, g};
    std::array<std::int32_t, 4> partner{};
    std::array<std::int32_t, 4> tail{};
    std::array<double, 4> outer_length{};
    for (std::size_t i = 0; i < 4; ++i) {
      partner[i] = t_.twin[at(from[i])];
      for (std::size_t j = 0; j < 4; ++j) {
        if (t_.twin[at(from[i])] == from[j]) partner[i] = to[j];
      }
      tail[i] = t_.tail[at(from[i])];
      outer_length[i] = t_.length[at(from[i])];
    }
    for (std::size_t i = 0; i < 4; ++i) {
      t_.tail[at(to[i])] = tail[i];
      t_.length[at(to[i])] = outer_length[i];
      t_.twin[at(to[i])] = partner[i];
      if (partner[i] >= 0) t_.twin[at(partner[i])] = to[i];
    }
    set_inner(f + 2, g + 2, tail[3], length);  // l to k
    set_inner(g + 2, f + 2, tail[1], length);  // k to l
    update_cotangents(f / 3);
    update_cotangents(g / 3);
    for (const std::int32_t outer : to) push_if_bad(outer);
  }

  void set_inner(std::int32_t h, std::int32_t twin, std::int32_t tail, double length) {
    t_.tail[at(h)] = tail;
    t_.twin[at(h)] = twin;
    t_.length[at(h)] = length;
  }

  IntrinsicTriangulation& t_;
  std::vector<double> cotangent_;
  std::vector<std::int32_t> stack_;
};

}  // namespace

std::vector<double> opposite_cotangents(const IntrinsicTriangulation& triangulation) {
  std::vector<double> opposite;
  opposite.reserve(triangulation.length.size());
  for (std::size_t h = 0; h < triangulation.length.size(); h += 3) {
    const std::array<double, 3> cotangent = cotangents_of(triangulation, h);
    opposite.insert(opposite.end(), cotangent.begin(), cotangent.end());
  }
  return opposite;
}

std::int64_t make_delaunay(IntrinsicTriangulation& triangulation) {
  return Flipper(triangulation).run();
}

}  // namespace timbre::detail
