#include "timbre/analysis/operators/detail/tufted_cover.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <tuple>

#include "timbre/analysis/mesh/sides.h"

namespace timbre::detail {
namespace {

using Eigen::Index;
using Eigen::RowVector3d;
using Eigen::VectorXd;

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

Faces corners_of(const Surface& surface) {
  Faces faces(static_cast<Index>(surface.faces.size()), 3);
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      faces(static_cast<Index>(f), static_cast<Index>(c)) = surface.faces[f].corner[c];
    }
  }
  return faces;
}

// The halfedge of a face on the edge that lies opposite `apex`, and its like in the back copy,
// whose corners are 0, 2, 1 of the front.
struct HalfedgePair {
  std::int32_t front = 0;
  std::int32_t back = 0;
};

HalfedgePair halfedges_of(const Surface& surface, const TriangleSide& side) {
  const auto& corner = surface.faces[at(side.face)].corner;
  const auto apex = static_cast<std::int32_t>(std::find(corner.begin(), corner.end(), side.apex) -
                                              corner.begin());
  const auto faces = static_cast<std::int32_t>(surface.faces.size());
  return {3 * side.face + (apex + 1) % 3, 3 * (faces + side.face) + (3 - (apex + 2) % 3) % 3};
}

void add_copies(const Surface& surface, bool with_back, IntrinsicTriangulation& cover) {
  const std::size_t sheets = with_back ? 2 : 1;
  cover.tail.reserve(3 * sheets * surface.faces.size());
  cover.length.reserve(3 * sheets * surface.faces.size());
  for (std::size_t sheet = 0; sheet < sheets; ++sheet) {
    const std::array<std::size_t, 3> order =
        sheet == 0 ? std::array<std::size_t, 3>{0, 1, 2} : std::array<std::size_t, 3>{0, 2, 1};
    for (const MetricFace& face : surface.faces) {
      for (std::size_t c = 0; c < 3; ++c) {
        cover.tail.push_back(face.corner[order[c]]);
        cover.length.push_back(face.length[order[(c + 2) % 3]]);  // opposite the third corner
      }
    }
  }
  cover.twin.assign(cover.tail.size(), -1);
}

void glue(IntrinsicTriangulation& cover, std::int32_t a, std::int32_t b) {
  cover.twin[at(a)] = b;
  cover.twin[at(b)] = a;
}

// A number for each vertex that hangs on the faces around it but not on anyone's numbering:
// tells most coincident vertices apart.
VectorXd fingerprints(const Surface& surface, const Points& places) {
  VectorXd print = places * Eigen::Vector3d(1.0, std::numbers::sqrt2, std::numbers::sqrt3);
  for (int round = 0; round < 2; ++round) {
    VectorXd around = VectorXd::Zero(print.size());
    for (const MetricFace& face : surface.faces) {
      const double a = print[face.corner[0]];
      const double b = print[face.corner[1]];
      const double c = print[face.corner[2]];
      const double of_face = a + b + c + std::sqrt(5.0) * std::abs((a - b) * (b - c) * (c - a));
      for (const std::int32_t corner : face.corner) around[corner] += of_face + 1.0 / 7.0;
    }
    print.array() += (7.0 * around.array()).sin();
  }
  return print;
}

// Positions in the box of their component, [0, 1].
Points places_in_component(const Surface& surface, const Points& positions) {
  const auto components = static_cast<Index>(surface.scales.size());
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Points low = Points::Constant(components, 3, kFar);
  Eigen::VectorXd extent = Eigen::VectorXd::Zero(components);
  const auto for_each_used = [&](const auto& visit) {
    for (Index v = 0; v < positions.rows(); ++v) {
      const std::int32_t c = surface.component[static_cast<std::size_t>(v)];
      if (c >= 0) visit(v, c);
    }
  };
  for_each_used([&](Index v, Index c) { low.row(c) = low.row(c).cwiseMin(positions.row(v)); });
  for_each_used([&](Index v, Index c) {
    extent[c] = std::max(extent[c], (positions.row(v) - low.row(c)).maxCoeff());
  });
  Points places = Points::Zero(positions.rows(), 3);
  for_each_used(
      [&](Index v, Index c) { places.row(v) = (positions.row(v) - low.row(c)) / extent[c]; });
  return places;
}

// The vertices' places in the order of their positions: x, then y, then z, to rounding.
std::vector<std::int32_t> ranks_by_position(const Surface& surface, const Points& positions) {
  const Points places = places_in_component(surface, positions);
  const VectorXd prints = fingerprints(surface, places);
  const auto coarse = [](double x, double step) { return std::round(x / step); };
  std::vector<std::int32_t> order(static_cast<std::size_t>(positions.rows()));
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](std::int32_t v) {
    return std::tuple(coarse(places(v, 0), 1e-12), coarse(places(v, 1), 1e-12),
                      coarse(places(v, 2), 1e-12), coarse(prints[v], 1e-9), v);
  };
  std::sort(order.begin(), order.end(),
            [&](std::int32_t a, std::int32_t b) { return key(a) < key(b); });
  std::vector<std::int32_t> rank(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) rank[at(order[i])] = static_cast<std::int32_t>(i);
  return rank;
}

// The order of three or more faces about their edge.
class AngularOrder {
 public:
  AngularOrder(const Surface& surface, const Points* positions) : positions_(positions) {
    rank_.resize(static_cast<std::size_t>(surface.vertices()));
    std::iota(rank_.begin(), rank_.end(), 0);
    if (positions != nullptr) rank_ = ranks_by_position(surface, *positions);
  }

  // Sorts the sides on one edge as one meets them turning about it, and tells the direction.
  // @return true if the edge runs from its larger vertex to its smaller
  [[nodiscard]] bool sort(std::span<TriangleSide> sides) const {
    const bool reversed = rank_[at(sides[0].low)] > rank_[at(sides[0].high)];
    const std::int32_t from = reversed ? sides[0].high : sides[0].low;
    const std::int32_t to = reversed ? sides[0].low : sides[0].high;
    std::sort(sides.begin(), sides.end(), [&](const TriangleSide& a, const TriangleSide& b) {
      return std::tuple(rank_of_apex(a), a.face) < std::tuple(rank_of_apex(b), b.face);
    });
    std::vector<Place> places(sides.size());
    for (std::size_t i = 0; i < sides.size(); ++i) {
      // Faces on the same corners lie upon each other: in the same order all around.
      const bool odd =
          rank_[at(from)] < rank_of_apex(sides[i]) && rank_of_apex(sides[i]) < rank_[at(to)];
      places[i] = {turn(sides[0].apex, sides[i].apex, from, to), rank_of_apex(sides[i]),
                   odd ? -sides[i].face : sides[i].face, sides[i]};
    }
    std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
      return std::tie(a.turn, a.rank, a.face) < std::tie(b.turn, b.rank, b.face);
    });
    for (std::size_t i = 0; i < sides.size(); ++i) sides[i] = places[i].side;
    return reversed;
  }

 private:
  struct Place {
    double turn = 0.0;
    std::int32_t rank = 0;
    std::int32_t face = 0;
    TriangleSide side;
  };

  [[nodiscard]] std::int32_t rank_of_apex(const TriangleSide& side) const {
    return rank_[at(side.apex)];
  }

  // The angle from the first face to this one in steps of `kGrain` turns. Cut, not rounded, so
  // that exact fractions of a turn do not stand between two steps; shifted by half a step, so
  // that nothing before 0 and a little after 0 falls together.
  [[nodiscard]] double turn(std::int32_t first, std::int32_t apex, std::int32_t from,
                            std::int32_t to) const {
    constexpr double kGrain = 1e-7;
    if (positions_ == nullptr) return 0.0;
    const RowVector3d origin = positions_->row(from);
    const RowVector3d axis = RowVector3d(positions_->row(to) - origin).stableNormalized();
    const auto across = [&](std::int32_t v) -> RowVector3d {
      const RowVector3d arm = positions_->row(v) - origin;
      return RowVector3d(arm - axis * axis.dot(arm)).stableNormalized();
    };
    const RowVector3d x = across(first);
    const RowVector3d y = axis.cross(x);
    const RowVector3d d = across(apex);
    const double turns = std::atan2(d.dot(y), d.dot(x)) / (2.0 * std::numbers::pi) + kGrain / 2.0;
    return std::floor((turns - std::floor(turns)) / kGrain);
  }

  const Points* positions_;
  std::vector<std::int32_t> rank_;
};

}  // namespace

IntrinsicTriangulation oriented_sheet(const Surface& surface) {
  const std::vector<TriangleSide> sides = sorted_sides(corners_of(surface));
  IntrinsicTriangulation sheet;
  add_copies(surface, false, sheet);
  for (std::size_t i = 0; i < sides.size();) {
    const std::size_t end = end_of_edge(sides, i);
    if (end - i > 2 || (end - i == 2 && sides[i].forward == sides[i + 1].forward)) return {};
    if (end - i == 2) {
      glue(sheet, halfedges_of(surface, sides[i]).front, halfedges_of(surface, sides[i + 1]).front);
    }
    i = end;
  }
  return sheet;
}

IntrinsicTriangulation tufted_cover(const Surface& surface, const Points* positions) {
  std::vector<TriangleSide> sides = sorted_sides(corners_of(surface));
  IntrinsicTriangulation cover;
  cover.share = 0.5;
  add_copies(surface, true, cover);
  const AngularOrder order(surface, positions);
  for (std::size_t i = 0; i < sides.size();) {
    const std::span about(sides.data() + i, end_of_edge(sides, i) - i);
    const bool reversed = about.size() > 2 && order.sort(about);
    for (std::size_t t = 0; t < about.size(); ++t) {
      const TriangleSide& next = about[(t + 1) % about.size()];
      const HalfedgePair here = halfedges_of(surface, about[t]);
      const HalfedgePair there = halfedges_of(surface, next);
      // The copy that runs up the edge is glued to the copy of the next face that runs down.
      glue(cover, about[t].forward != reversed ? here.front : here.back,
           next.forward != reversed ? there.back : there.front);
    }
    i += about.size();
  }
  return cover;
}

}  // namespace timbre::detail
