#include "timbre/cli/render/transfer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "timbre/analysis/core/error.h"

namespace timbre::cli {
namespace {

using Eigen::Index;

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

// Half by value, half by rank: what is small and thin still gets a share of the colours.
Eigen::VectorXf spread(const Eigen::VectorXd& values) {
  const Index n = values.size();
  std::vector<Index> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    return values(a) != values(b) ? values(a) < values(b) : a < b;
  });
  const double low = values(order.front());
  const double extent = values(order.back()) - low;
  Eigen::VectorXf places = Eigen::VectorXf::Constant(n, 0.5F);
  if (!(extent > 0.0)) return places;
  // Equal values share a rank: vertex order must not show.
  for (std::size_t i = 0, end = 0; i < order.size(); i = end) {
    end = i + 1;
    while (end < order.size() && values(order[end]) == values(order[i])) ++end;
    const double rank = 0.5 * static_cast<double>(i + end - 1) / static_cast<double>(n - 1);
    const double value = (values(order[i]) - low) / extent;
    for (std::size_t j = i; j < end; ++j) {
      places(order[j]) = static_cast<float>(0.5 * rank + 0.5 * value);
    }
  }
  return places;
}

// Colours at the corners of the box around the mesh: [side][end][top].
using BoxColours = std::array<std::array<std::array<Colour, 2>, 2>, 2>;

// Left and right are blues against greens and oranges, which all eyes tell apart.
const BoxColours& box_colours() {
  static const BoxColours kBox = [] {
    constexpr std::array<std::array<double, 2>, 2> kHues{{{258.0, 335.0}, {160.0, 65.0}}};
    BoxColours box;
    for (std::size_t side = 0; side < 2; ++side) {
      for (std::size_t end = 0; end < 2; ++end) {
        box[side][end][0] = colour_of(52.0, 0.2, kHues[side][end]);
        box[side][end][1] = colour_of(85.0, 0.15, kHues[side][end]);
      }
    }
    return box;
  }();
  return kBox;
}

struct Contribution {
  std::int32_t from, to;
};

std::vector<Contribution> edges_of(const Faces& faces) {
  std::vector<Contribution> edges;
  edges.reserve(6 * static_cast<std::size_t>(faces.rows()));
  for (Index f = 0; f < faces.rows(); ++f) {
    for (int c = 0; c < 3; ++c) {
      edges.push_back({faces(f, c), faces(f, (c + 1) % 3)});
      edges.push_back({faces(f, (c + 1) % 3), faces(f, c)});
    }
  }
  return edges;
}

// Rings that are filled: three where both meshes are alike, more where the target is finer.
int rings_to_fill(Index source, Index target) {
  const double finer = std::sqrt(static_cast<double>(target) / static_cast<double>(source));
  return static_cast<int>(std::ceil(3.0 * std::clamp(finer, 1.0, 30.0)));
}

void fill_rings(VertexColours& colours, const Faces& faces, int rings) {
  const std::vector<Contribution> edges = edges_of(faces);
  for (int ring = 0; ring < rings; ++ring) {
    VertexColours sums = VertexColours::Zero(colours.rows(), 3);
    Eigen::VectorXf counts = Eigen::VectorXf::Zero(colours.rows());
    for (const auto& [from, to] : edges) {
      if (std::isnan(colours(from, 0)) || !std::isnan(colours(to, 0))) continue;
      sums.row(to) += colours.row(from);
      counts(to) += 1.0F;
    }
    if (counts.isZero(0.0F)) return;
    for (Index v = 0; v < colours.rows(); ++v) {
      if (counts(v) > 0.0F) colours.row(v) = sums.row(v) / counts(v);
    }
  }
}

void require_map_makes_sense(const VertexColours& source, const std::vector<std::int32_t>& map,
                             Index target) {
  if (static_cast<Index>(map.size()) != source.rows()) {
    throw Error(ErrorKind::bad_request, "", "map",
                "has " + std::to_string(map.size()) + " entries, but the source has " +
                    std::to_string(source.rows()) + " vertices");
  }
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (map[i] >= -1 && map[i] < target) continue;
    throw Error(ErrorKind::bad_request, "", "map entry " + std::to_string(i),
                std::to_string(map[i]) + " is no vertex of the target, which has " +
                    std::to_string(target) + ", from 0; -1 stands for none");
  }
}

}  // namespace

VertexColours position_colours(const TriangleMesh& mesh, UpAxis up) {
  // A power of two keeps the rotation exact, and in range.
  const double largest = std::max(mesh.vertices.cwiseAbs().maxCoeff(), 1e-300);
  const Points points =
      mesh.vertices / std::exp2(std::ilogb(largest)) * rotation_to_y_up(up).transpose();
  const Eigen::RowVector3d extent = points.colwise().maxCoeff() - points.colwise().minCoeff();
  const int longer = extent(0) >= extent(2) ? 0 : 2;
  // Steepest in the middle: between blue and orange lies grey, which says little.
  const Eigen::VectorXf side =
      spread(points.col(2 - longer)).unaryExpr([](float t) { return t * t * (3.0F - 2.0F * t); });
  const Eigen::VectorXf end = spread(points.col(longer));
  const Eigen::VectorXf top = spread(points.col(1));
  VertexColours colours = VertexColours::Zero(points.rows(), 3);
  for (Index v = 0; v < points.rows(); ++v) {
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const std::size_t s = corner >> 2;
      const std::size_t e = (corner >> 1) & 1;
      const std::size_t t = corner & 1;
      const float weight = (s == 1 ? side(v) : 1.0F - side(v)) * (e == 1 ? end(v) : 1.0F - end(v)) *
                           (t == 1 ? top(v) : 1.0F - top(v));
      colours.row(v) += weight * box_colours()[s][e][t].transpose();
    }
  }
  return colours;
}

VertexColours carry_colours(const VertexColours& source, const std::vector<std::int32_t>& map,
                            const TriangleMesh& target) {
  const Index n = target.vertices.rows();
  require_map_makes_sense(source, map, n);
  VertexColours colours = VertexColours::Zero(n, 3);
  Eigen::VectorXf counts = Eigen::VectorXf::Zero(n);
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (map[i] < 0) continue;
    colours.row(map[i]) += source.row(static_cast<Index>(i));
    counts(map[i]) += 1.0F;
  }
  for (Index v = 0; v < n; ++v) {
    colours.row(v) = counts(v) > 0.0F ? Eigen::RowVector3f(colours.row(v) / counts(v))
                                      : Eigen::RowVector3f::Constant(kNone);
  }
  fill_rings(colours, target.faces, rings_to_fill(source.rows(), n));
  return colours;
}

VertexColours matched_colours(const VertexColours& source, const std::vector<std::int32_t>& map) {
  VertexColours colours = source;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (map[i] < 0) colours.row(static_cast<Index>(i)).setConstant(kNone);
  }
  return colours;
}

}  // namespace timbre::cli
