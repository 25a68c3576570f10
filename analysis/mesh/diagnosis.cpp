#include "timbre/analysis/mesh/diagnosis.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <type_traits>
#include <utility>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/mesh/detail/grouping.h"
#include "timbre/analysis/mesh/triangle.h"

namespace timbre {
namespace {

using Index = std::int32_t;

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

// Union-find that also knows whether a member is turned against its set's root.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count), turned_(count, false) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  Index root(Index i) {
    Index top = i;
    bool turned = false;
    for (; parent_[at(top)] != top; top = parent_[at(top)]) turned = turned != turned_[at(top)];
    while (parent_[at(i)] != top && i != top) {  // shortens the path
      const Index next = std::exchange(parent_[at(i)], top);
      const bool step = turned_[at(i)];
      turned_[at(i)] = turned;
      turned = turned != step;
      i = next;
    }
    return top;
  }

  bool is_turned(Index i) {
    root(i);  // from here on the parent is the root
    return turned_[at(i)];
  }

  /// False if both were in one set already, turned otherwise than now said.
  bool join(Index i, Index j, bool turned = false) {
    const bool relative = (is_turned(i) != is_turned(j)) != turned;
    Index a = root(i);
    Index b = root(j);
    if (a == b) return !relative;
    if (a > b) std::swap(a, b);
    parent_[at(b)] = a;
    turned_[at(b)] = relative;
    return true;
  }

 private:
  std::vector<Index> parent_;
  std::vector<bool> turned_;
};

// The triangles that have three different corners.
std::vector<Index> proper_faces(const Faces& faces) {
  if (faces.size() > std::numeric_limits<Index>::max()) {
    throw Error(ErrorKind::bad_input, "", "faces", "more than 715827882 triangles");
  }
  std::vector<Index> proper;
  proper.reserve(static_cast<std::size_t>(faces.rows()));
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    const auto corner = faces.row(f);
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
    proper.push_back(static_cast<Index>(f));
  }
  return proper;
}

std::vector<Index> corners_of(const Faces& faces, const std::vector<Index>& some) {
  std::vector<Index> corners;
  corners.reserve(3 * some.size());
  for (const Index f : some) {
    corners.insert(corners.end(), {faces(f, 0), faces(f, 1), faces(f, 2)});
  }
  return corners;
}

// Corner k of the f-th such triangle is number 3 f + k; so is the edge from it to the next.
class Examination {
 public:
  Examination(const TriangleMesh& mesh, std::size_t listed)
      : mesh_(mesh),
        listed_(listed),
        vertex_count_(static_cast<std::size_t>(mesh.vertices.rows())),
        unit_(unit_of({mesh.vertices.data(), static_cast<std::size_t>(mesh.vertices.size())})),
        proper_(proper_faces(mesh.faces)),
        corners_(corners_of(mesh.faces, proper_)),
        fans_(corners_.size()),
        sides_(corners_.size() / 3) {}

  Diagnosis run() {
    found_.vertices = mesh_.vertices.rows();
    found_.faces = mesh_.faces.rows();
    find_odd_faces();
    measure_triangles();
    find_coincident_vertices();
    find_edges();
    find_components();
    join_across_edges();
    find_fans();
    find_boundary();
    found_.manifold = found_.nonmanifold_edges == 0 && found_.nonmanifold_vertices == 0;
    find_genus();
    measure();
    return std::move(found_);
  }

 private:
  [[nodiscard]] const double* position(Index vertex) const {
    return mesh_.vertices.data() + 3 * at(vertex);
  }
  // In units of `unit_`.
  [[nodiscard]] Eigen::Vector3d point(std::size_t corner) const {
    return Eigen::Map<const Eigen::Vector3d>(position(corners_[corner])) / unit_;
  }
  [[nodiscard]] std::size_t corner_count() const { return corners_.size(); }
  static Index next(Index corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
  [[nodiscard]] std::pair<Index, Index> ends(Index edge) const {
    return std::minmax(corners_[at(edge)], corners_[at(next(edge))]);
  }

  void find_odd_faces() {
    const auto faces = static_cast<std::size_t>(mesh_.faces.rows());
    std::vector<std::array<Index, 3>> sorted(faces);
    for (std::size_t f = 0; f < faces; ++f) {
      const Index* const corner = mesh_.faces.data() + 3 * f;
      sorted[f] = {corner[0], corner[1], corner[2]};
      std::sort(sorted[f].begin(), sorted[f].end());
      const bool repeats = sorted[f][0] == sorted[f][1] || sorted[f][1] == sorted[f][2];
      if (repeats ||
          has_no_area(position(corner[0]), position(corner[1]), position(corner[2]), 1.0 / unit_)) {
        note(found_.degenerate_faces, found_.first_degenerate_faces, static_cast<Index>(f));
      }
    }
    const auto first = detail::first_equal(
        faces, vertex_count_, [&](std::size_t f) { return at(sorted[f][0]); },
        [&](std::size_t f, std::size_t g) { return sorted[f] < sorted[g]; });
    for (std::size_t f = 0; f < faces; ++f) {
      if (at(first[f]) == f) continue;
      note(found_.duplicate_faces, found_.first_duplicate_faces, static_cast<Index>(f));
    }
  }

  // Angles and lengths; the smallest angle lies opposite the shortest edge.
  void measure_triangles() {
    if (corner_count() == 0) return;
    double smallest = 60.0;
    double shortest = std::numeric_limits<double>::infinity();
    double longest = 0.0;
    double sum = 0.0;
    double largest_coordinate = 0.0;
    for (std::size_t c = 0; c < corner_count(); c += 3) {
      const std::array<Eigen::Vector3d, 3> p = {point(c), point(c + 1), point(c + 2)};
      std::array<double, 3> opposite{};
      for (std::size_t k = 0; k < 3; ++k) {
        opposite[k] = (p[(k + 2) % 3] - p[(k + 1) % 3]).stableNorm();
        sum += opposite[k];
        largest_coordinate = std::max(largest_coordinate, p[k].cwiseAbs().maxCoeff());
      }
      const auto least = static_cast<std::size_t>(
          std::min_element(opposite.begin(), opposite.end()) - opposite.begin());
      shortest = std::min(shortest, opposite[least]);
      longest = std::max(longest, *std::max_element(opposite.begin(), opposite.end()));
      const double angle = angle_at(p[least], p[(least + 1) % 3], p[(least + 2) % 3]);
      smallest = std::min(smallest, angle);
      if (angle > 0.0 && angle < kThinAngle) {
        note(found_.thin_faces, found_.first_thin_faces, proper_[c / 3]);
      }
    }
    found_.smallest_angle = smallest;
    found_.shortest_edge = shortest * unit_;
    found_.longest_edge = longest * unit_;
    const double mean = sum / static_cast<double>(corner_count());
    found_.mean_edge = mean * unit_;
    const double grain = std::numeric_limits<double>::epsilon() * largest_coordinate;
    if (mean > grain) found_.digits = std::log10(mean / grain);
  }

  // Degrees; 0 where the triangle has no area to rounding.
  static double angle_at(const Eigen::Vector3d& corner, const Eigen::Vector3d& a,
                         const Eigen::Vector3d& b) {
    if (has_no_area(corner.data(), a.data(), b.data(), 1.0)) return 0.0;
    const Eigen::Vector3d u = (a - corner).stableNormalized();
    const Eigen::Vector3d v = (b - corner).stableNormalized();
    return std::atan2(u.cross(v).norm(), u.dot(v)) * 180.0 / std::numbers::pi;
  }

  void find_coincident_vertices() {
    const std::span coordinates(mesh_.vertices.data(),
                                static_cast<std::size_t>(mesh_.vertices.size()));
    for (const Index vertex : detail::repeated_positions(coordinates)) {
      note(found_.coincident_vertices, found_.first_coincident_vertices, vertex);
    }
  }

  void find_edges() {
    leader_ = detail::first_equal(
        corner_count(), vertex_count_,
        [&](std::size_t e) { return at(ends(static_cast<Index>(e)).first); },
        [&](std::size_t e, std::size_t g) {
          return ends(static_cast<Index>(e)) < ends(static_cast<Index>(g));
        });
    triangles_at_.assign(corner_count(), 0);
    for (const Index edge : leader_) ++triangles_at_[at(edge)];
    bad_vertex_.assign(vertex_count_, false);
    for (std::size_t e = 0; e < corner_count(); ++e) {
      if (triangles_at_[e] == 0 || triangles_at_[e] == 2) continue;
      const auto [low, high] = ends(static_cast<Index>(e));
      if (triangles_at_[e] == 1) {
        note(found_.boundary_edges, found_.first_boundary_edges, {low, high});
        continue;
      }
      bad_vertex_[at(low)] = bad_vertex_[at(high)] = true;
      note(found_.nonmanifold_edges, found_.first_nonmanifold_edges, {low, high});
    }
  }

  void find_components() {
    Sets sets(vertex_count_);
    used_.assign(vertex_count_, false);
    for (std::size_t c = 0; c < corner_count(); ++c) {
      used_[at(corners_[c])] = true;
      sets.join(corners_[c], corners_[c - c % 3]);
    }
    for (std::size_t v = 0; v < vertex_count_; ++v) {
      const auto vertex = static_cast<Index>(v);
      if (!used_[v]) {
        note(found_.unused_vertices, found_.first_unused_vertices, vertex);
      } else if (sets.root(vertex) == vertex) {
        ++found_.components;
      }
    }
  }

  // Corners that meet at a shared edge belong to one fan; triangles that share an edge
  // with no third are turned alike if they run along it in opposite ways.
  void join_across_edges() {
    for (std::size_t e = 0; e < corner_count(); ++e) {
      const auto edge = static_cast<Index>(e);
      const Index other = leader_[e];
      if (other == edge) continue;
      const bool same_way = corners_[e] == corners_[at(other)];
      fans_.join(edge, same_way ? other : next(other));
      fans_.join(next(edge), same_way ? next(other) : other);
      if (triangles_at_[at(other)] != 2) continue;
      if (same_way) {
        const auto [low, high] = ends(edge);
        note(found_.flipped_edges, found_.first_flipped_edges, {low, high});
      }
      if (!sides_.join(edge / 3, other / 3, same_way)) found_.orientable = false;
    }
  }

  void find_fans() {
    std::vector<bool> seen(vertex_count_, false);
    for (std::size_t c = 0; c < corner_count(); ++c) {
      if (fans_.root(static_cast<Index>(c)) != static_cast<Index>(c)) continue;
      if (seen[at(corners_[c])]) bad_vertex_[at(corners_[c])] = true;
      seen[at(corners_[c])] = true;
    }
    for (std::size_t v = 0; v < vertex_count_; ++v) {
      if (!bad_vertex_[v]) continue;
      note(found_.nonmanifold_vertices, found_.first_nonmanifold_vertices, static_cast<Index>(v));
    }
  }

  // Boundary edges that end in the same fan belong to one loop.
  void find_boundary() {
    Sets loops(corner_count());
    std::vector<bool> on_boundary(corner_count(), false);
    for (std::size_t e = 0; e < corner_count(); ++e) {
      if (triangles_at_[e] != 1) continue;
      const Index from = fans_.root(static_cast<Index>(e));
      const Index to = fans_.root(next(static_cast<Index>(e)));
      on_boundary[at(from)] = on_boundary[at(to)] = true;
      loops.join(from, to);
    }
    for (std::size_t c = 0; c < corner_count(); ++c) {
      const auto corner = static_cast<Index>(c);
      if (on_boundary[c] && loops.root(corner) == corner) ++found_.boundary_loops;
    }
  }

  // Euler: V - E + F = 2 - 2 g - b, or 2 - g - b where the surface is not orientable.
  void find_genus() {
    if (found_.components != 1 || !found_.manifold) return;
    const auto edges = std::count_if(triangles_at_.begin(), triangles_at_.end(),
                                     [](Index triangles) { return triangles > 0; });
    const std::int64_t euler = found_.vertices - found_.unused_vertices - edges +
                               static_cast<std::int64_t>(corner_count() / 3);
    const std::int64_t missing = 2 - euler - found_.boundary_loops;
    found_.genus = found_.orientable ? missing / 2 : missing;
  }

  void measure() {
    double area = 0.0;
    for (std::size_t c = 0; c < corner_count(); c += 3) {
      area += triangle_area(position(corners_[c]), position(corners_[c + 1]),
                            position(corners_[c + 2]), 1.0 / unit_);
    }
    found_.area = area * unit_ * unit_;
    const bool closed = found_.boundary_edges == 0 && found_.nonmanifold_edges == 0;
    if (closed && found_.orientable && corner_count() > 0) {
      found_.volume = volume() * unit_ * unit_ * unit_;
    }
  }

  // Signed tetrahedra over a point of the mesh, for each set of triangles turned alike.
  double volume() {
    using Vector = Eigen::Vector3d;
    const Vector origin = point(0);
    std::vector<double> signed_volume(corner_count() / 3, 0.0);
    std::vector<std::int64_t> unturned(corner_count() / 3, 0);
    for (std::size_t f = 0; f < signed_volume.size(); ++f) {
      const Vector a = point(3 * f) - origin;
      const Vector b = point(3 * f + 1) - origin;
      const Vector c = point(3 * f + 2) - origin;
      const auto face = static_cast<Index>(f);
      const int sign = sides_.is_turned(face) ? -1 : 1;
      signed_volume[at(sides_.root(face))] += sign * a.dot(b.cross(c)) / 6.0;
      unturned[at(sides_.root(face))] += sign;
    }
    double sum = 0.0;
    for (std::size_t f = 0; f < signed_volume.size(); ++f) {
      sum += unturned[f] < 0 ? -signed_volume[f] : signed_volume[f];
    }
    return std::abs(sum);
  }

  template <typename Place>
  void note(std::int64_t& count, std::vector<Place>& first,
            const std::type_identity_t<Place>& place) const {
    ++count;
    if (first.size() < listed_) first.push_back(place);
  }

  const TriangleMesh& mesh_;
  std::size_t listed_;
  std::size_t vertex_count_;
  double unit_;
  std::vector<Index> proper_;  // faces
  std::vector<Index> corners_;
  Sets fans_;                        // of corners around a vertex
  Sets sides_;                       // of triangles; turned: seen from the other side
  std::vector<Index> leader_;        // of each edge: the first that joins the same vertices
  std::vector<Index> triangles_at_;  // of each leading edge
  std::vector<bool> used_, bad_vertex_;
  Diagnosis found_;
};

}  // namespace

Diagnosis diagnose(const TriangleMesh& mesh, std::size_t listed) {
  return Examination(mesh, listed).run();
}

}  // namespace timbre
