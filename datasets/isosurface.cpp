#include "timbre/datasets/isosurface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "timbre/datasets/detail/half_surface.h"

namespace timbre {
namespace {

using detail::HalfSurface;
using detail::Triangle;
using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr double kSnap = 0.3;    // lattice points closer than this, in cells, move
constexpr double kMargin = 2.0;  // of lattice around the box, in cells
constexpr double kFar = 4.0;     // in half cells; tetrahedra are two long
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kRounds = 12;  // of relaxation; more changes little

// A body-centred cubic lattice, turned by 45 degrees about y: then the plane x = 0 is one
// of the planes that cut no tetrahedron. Nodes are (u, v, w) with an even sum, at
// (u a, w cell / 2, v a) with a = cell / sqrt 2; in cubic coordinates, in half cells,
// they are (i, j, k) = (v + u, v - u, w), all odd or all even.
class Lattice {
 public:
  // What lies at x < 0 is left out.
  Lattice(const ImplicitFunction& f, const Eigen::AlignedBox3d& box, double cell)
      : f_(f), step_(cell / std::sqrt(2.0), cell / 2.0, cell / std::sqrt(2.0)) {
    const Vector3d margin = Vector3d::Constant(kMargin * cell);
    corner_ = box.min() - margin;
    corner_.x() = std::max(corner_.x(), 0.0);
    const Vector3d extent = (box.max() + margin - corner_).cwiseQuotient(step_);
    size_ = extent.array().ceil().cast<int>() + 1;
    std::swap(size_.y(), size_.z());  // u, v, w run along x, z, y
    evaluate(kSnap * cell);
  }

  HalfSurface march() {
    for (int u = 0; u < size_[0]; ++u) {
      for (int v = 0; v < size_[1]; ++v) {
        for (int w = 1; w < size_[2]; w += 2) {
          if ((u + v + w) % 2 == 0) cut_around({v + u, v - u, w});
        }
      }
    }
    for (const auto& [corners, face] : faces_) surface_.faces.push_back(face);
    return std::move(surface_);
  }

 private:
  using Node = std::int64_t;

  [[nodiscard]] Node node(int u, int v, int w) const {
    return (static_cast<Node>(u) * size_[1] + v) * size_[2] + w;
  }

  // -1 outside the half space or the box.
  [[nodiscard]] Node node(const Vector3i& cubic) const {
    const Vector3i at((cubic[0] - cubic[1]) / 2, (cubic[0] + cubic[1]) / 2, cubic[2]);
    if ((cubic[0] < cubic[1]) || (at.array() < 0).any() || (at.array() >= size_.array()).any()) {
      return -1;
    }
    return node(at[0], at[1], at[2]);
  }

  [[nodiscard]] Vector3d position(Node n) const {
    const Node column = n / size_[2];
    const Eigen::Matrix<Node, 3, 1> at(column / size_[1], n % size_[2], column % size_[1]);
    return corner_ + step_.cwiseProduct(at.cast<double>());
  }

  // Nodes near the surface count as on it, and nodes that no tetrahedron joins to it as
  // infinitely far. Many of these the value at another node tells.
  void evaluate(double snap) {
    value_.assign(static_cast<std::size_t>(size_.cast<Node>().prod()), 0.0);
    for (int u = 0; u < size_[0]; ++u) {
      for (int v = 0; v < size_[1]; ++v) {
        double known = 0.0;
        int clear = 0;
        for (int w = (u + v) % 2; w < size_[2]; w += 2) {
          const Node n = node(u, v, w);
          if (clear-- <= 0) {
            const ImplicitValue here = f_(position(n));
            known = detail::distance_estimate(here);
            // Half, because the slope may be a little above 1.
            clear = static_cast<int>(0.5 * std::abs(here.value) / (2.0 * step_.y())) - 1;
            if (std::abs(here.value) > kFar * step_.y()) known = std::copysign(kInfinity, known);
          }
          value_[static_cast<std::size_t>(n)] = std::abs(known) < snap ? 0.0 : known;
        }
      }
    }
  }

  // All tetrahedra whose long edge starts at an odd node and runs up an axis.
  void cut_around(const Vector3i& from) {
    if (const Node n = node(from); n < 0 || std::isinf(value_[static_cast<std::size_t>(n)])) return;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3i along = Vector3i::Unit(axis);
      const Vector3i side = Vector3i::Unit((axis + 1) % 3);
      const Vector3i up = Vector3i::Unit((axis + 2) % 3);
      const Vector3i centre = from + along;
      const std::array<Vector3i, 4> ring = {centre + side + up, centre - side + up,
                                            centre - side - up, centre + side - up};
      for (std::size_t r = 0; r < 4; ++r) {
        // The turn of the lattice also mirrors it, hence the ring backwards.
        const std::array tet = {node(from), node(centre + along), node(ring[(r + 1) % 4]),
                                node(ring[r])};
        if (*std::min_element(tet.begin(), tet.end()) >= 0) cut(tet);
      }
    }
  }

  // Triangles between the inside and the outside part of a positively oriented tetrahedron.
  void cut(std::array<Node, 4> t) {
    const auto value = [&](std::size_t i) { return value_[static_cast<std::size_t>(t[i])]; };
    bool odd = false;
    for (std::size_t end = 3; end > 0; --end) {
      for (std::size_t i = 0; i < end; ++i) {
        if (value(i) <= value(i + 1)) continue;
        std::swap(t[i], t[i + 1]);
        odd = !odd;
      }
    }
    const auto inside = (value(0) < 0.0) + (value(1) < 0.0) + (value(2) < 0.0) + (value(3) < 0.0);
    if (inside == 1) {
      add({point(t[0], t[1]), point(t[0], t[2]), point(t[0], t[3])}, odd);
    } else if (inside == 2 && value(3) > 0.0) {
      const std::int32_t first = point(t[0], t[2]);
      const std::int32_t second = point(t[0], t[3]);
      const std::int32_t third = point(t[1], t[3]);
      add({first, second, third}, odd);
      if (value(2) > 0.0) add({first, third, point(t[1], t[2])}, odd);
    } else if (inside == 3 && value(3) > 0.0) {
      add({point(t[0], t[3]), point(t[1], t[3]), point(t[2], t[3])}, odd);
    }
  }

  // Where the surface leaves the edge from `inside` to `outside`: at a node on it, or between.
  std::int32_t point(Node inside, Node outside) {
    const double low = value_[static_cast<std::size_t>(inside)];
    const double high = value_[static_cast<std::size_t>(outside)];
    const Node start = high == 0.0 ? outside : inside;
    const auto next = static_cast<std::int32_t>(surface_.points.size());
    const auto [entry, is_new] = points_.try_emplace({start, outside}, next);
    if (is_new) {
      const Vector3d a = position(start);
      const Vector3d b = position(outside);
      surface_.points.push_back(detail::project(f_, a + low / (low - high) * (b - a)));
    }
    return entry->second;
  }

  // A sheet of nodes on the surface between two inside parts is no surface: its triangles
  // come once from each side and cancel.
  void add(Triangle face, bool turned) {
    if (turned) std::swap(face[1], face[2]);
    Triangle corners = face;
    std::sort(corners.begin(), corners.end());
    const auto [entry, is_new] = faces_.try_emplace(corners, face);
    if (!is_new) faces_.erase(entry);
  }

  const ImplicitFunction& f_;
  Vector3d step_, corner_;
  Vector3i size_;
  std::vector<double> value_;
  std::map<std::pair<Node, Node>, std::int32_t> points_;
  std::map<Triangle, Triangle> faces_;
  HalfSurface surface_;
};

MirroredMesh mirrored(const HalfSurface& half) {
  MirroredMesh whole;
  const auto n = static_cast<std::int32_t>(half.points.size());
  std::vector<Vector3d> points = half.points;
  whole.mirror.resize(points.size());
  for (std::int32_t v = 0; v < n; ++v) {
    const auto at = static_cast<std::size_t>(v);
    whole.mirror[at] = v;
    if (half.in_plane(v)) continue;
    whole.mirror[at] = static_cast<std::int32_t>(points.size());
    whole.mirror.push_back(v);
    points.emplace_back(-points[at].x(), points[at].y(), points[at].z());
  }
  whole.mesh.vertices.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t v = 0; v < points.size(); ++v) {
    whole.mesh.vertices.row(static_cast<Eigen::Index>(v)) = points[v];
  }
  const auto m = static_cast<Eigen::Index>(half.faces.size());
  whole.mesh.faces.resize(2 * m, 3);
  for (Eigen::Index f = 0; f < m; ++f) {
    const Triangle& face = half.faces[static_cast<std::size_t>(f)];
    const auto image = [&](std::size_t c) {
      return whole.mirror[static_cast<std::size_t>(face[c])];
    };
    whole.mesh.faces.row(f) << face[0], face[1], face[2];
    whole.mesh.faces.row(m + f) << image(0), image(2), image(1);
  }
  return whole;
}

}  // namespace

MirroredMesh make_isosurface(const ImplicitFunction& f, const Eigen::AlignedBox3d& box,
                             double cell) {
  HalfSurface half = Lattice(f, box, cell).march();
  detail::relax(half, f, kRounds);
  return mirrored(half);
}

TriangleMesh make_isosurface(const ImplicitFunction& f, const Eigen::AlignedBox3d& box, double cell,
                             const Eigen::Quaterniond& turn) {
  // Turned, and moved to where no point comes near the plane x = 0, which is special.
  Eigen::AlignedBox3d turned;
  for (int corner = 0; corner < 8; ++corner) {
    turned.extend(turn * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
  }
  const Eigen::Isometry3d move =
      Eigen::Translation3d(Vector3d::UnitX() * ((kMargin + 1.0) * cell - turned.min().x())) * turn;
  const Eigen::Isometry3d back = move.inverse();
  const ImplicitFunction moved = [&](const Vector3d& point) {
    ImplicitValue here = f(back * point);
    here.gradient = turn * here.gradient;
    return here;
  };
  turned.translate(move.translation());
  detail::HalfSurface whole = Lattice(moved, turned, cell).march();
  detail::relax(whole, moved, kRounds);
  TriangleMesh mesh;
  mesh.vertices.resize(static_cast<Eigen::Index>(whole.points.size()), 3);
  for (std::size_t v = 0; v < whole.points.size(); ++v) {
    mesh.vertices.row(static_cast<Eigen::Index>(v)) = back * whole.points[v];
  }
  mesh.faces.resize(static_cast<Eigen::Index>(whole.faces.size()), 3);
  for (std::size_t t = 0; t < whole.faces.size(); ++t) {
    const Triangle& face = whole.faces[t];
    mesh.faces.row(static_cast<Eigen::Index>(t)) << face[0], face[1], face[2];
  }
  return mesh;
}

}  // namespace timbre
