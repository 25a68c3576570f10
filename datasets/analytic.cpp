#include "timbre/datasets/analytic.h"

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

namespace timbre {
namespace {

constexpr double kTau = 2.0 * std::numbers::pi;

TriangleMesh assembled(const std::vector<Eigen::RowVector3d>& points,
                       const std::vector<Eigen::RowVector3i>& faces) {
  TriangleMesh mesh;
  mesh.vertices.resize(static_cast<Eigen::Index>(points.size()), 3);
  mesh.faces.resize(static_cast<Eigen::Index>(faces.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    mesh.vertices.row(static_cast<Eigen::Index>(i)) = points[i];
  }
  for (std::size_t i = 0; i < faces.size(); ++i) {
    mesh.faces.row(static_cast<Eigen::Index>(i)) = faces[i];
  }
  return mesh;
}

std::vector<Eigen::RowVector3d> icosahedron_points() {
  std::vector<Eigen::RowVector3d> points = {{0.0, 0.0, 1.0}};
  const double height = 1.0 / std::sqrt(5.0);
  for (int ring = 0; ring < 2; ++ring) {
    for (int i = 0; i < 5; ++i) {
      const double angle = kTau * (i + 0.5 * ring) / 5.0;
      points.emplace_back(2.0 * height * std::cos(angle), 2.0 * height * std::sin(angle),
                          ring == 0 ? height : -height);
    }
  }
  points.emplace_back(0.0, 0.0, -1.0);
  return points;
}

std::vector<Eigen::RowVector3i> icosahedron_faces() {
  std::vector<Eigen::RowVector3i> faces;
  for (int i = 0; i < 5; ++i) {
    const int next = (i + 1) % 5;
    faces.emplace_back(0, 1 + i, 1 + next);
    faces.emplace_back(1 + i, 6 + i, 1 + next);
    faces.emplace_back(1 + next, 6 + i, 6 + next);
    faces.emplace_back(6 + i, 11, 6 + next);
  }
  return faces;
}

// Points of a divided face are named by their integer weights on the corners, so that
// neighbours share those on a common edge.
class SphereBuilder {
 public:
  explicit SphereBuilder(int frequency) : frequency_(frequency), corners_(icosahedron_points()) {}

  TriangleMesh build() {
    for (const Eigen::RowVector3i& face : icosahedron_faces()) divide(face);
    return assembled(points_, faces_);
  }

 private:
  int point(const Eigen::RowVector3i& face, int i, int j) {
    std::map<int, int> name;
    const std::array weight = {frequency_ - i - j, i, j};
    Eigen::RowVector3d position = Eigen::RowVector3d::Zero();
    for (int c = 0; c < 3; ++c) {
      const int w = weight[static_cast<std::size_t>(c)];
      if (w == 0) continue;
      name[face[c]] = w;
      position += w * corners_[static_cast<std::size_t>(face[c])];
    }
    const auto [entry, is_new] = index_.try_emplace(name, static_cast<int>(points_.size()));
    if (is_new) points_.push_back(position.normalized());
    return entry->second;
  }

  void divide(const Eigen::RowVector3i& face) {
    for (int i = 0; i < frequency_; ++i) {
      for (int j = 0; i + j < frequency_; ++j) {
        const int a = point(face, i, j);
        const int b = point(face, i + 1, j);
        const int c = point(face, i, j + 1);
        faces_.emplace_back(a, b, c);
        if (i + j + 1 < frequency_) faces_.emplace_back(b, point(face, i + 1, j + 1), c);
      }
    }
  }

  int frequency_;
  std::vector<Eigen::RowVector3d> corners_, points_;
  std::vector<Eigen::RowVector3i> faces_;
  std::map<std::map<int, int>, int> index_;
};

}  // namespace

TriangleMesh make_sphere(int frequency) { return SphereBuilder(frequency).build(); }

TriangleMesh make_rectangle(double width, double height, int nx, int ny) {
  std::vector<Eigen::RowVector3d> points;
  std::vector<Eigen::RowVector3i> faces;
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) points.emplace_back(width * i / nx, height * j / ny, 0.0);
  }
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const int corner = j * (nx + 1) + i;
      faces.emplace_back(corner, corner + 1, corner + nx + 2);
      faces.emplace_back(corner, corner + nx + 2, corner + nx + 1);
    }
  }
  return assembled(points, faces);
}

TriangleMesh make_disk(int rings) {
  std::vector<Eigen::RowVector3d> points = {{0.0, 0.0, 0.0}};
  std::vector<Eigen::RowVector3i> faces;
  const auto ring_start = [](int r) { return r == 0 ? 0 : 1 + 3 * r * (r - 1); };
  const auto at = [&](int r, int i) { return r == 0 ? 0 : ring_start(r) + i % (6 * r); };
  for (int r = 1; r <= rings; ++r) {
    for (int i = 0; i < 6 * r; ++i) {
      const double angle = kTau * i / (6 * r);
      const double radius = static_cast<double>(r) / rings;
      points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.0);
    }
    for (int sector = 0; sector < 6; ++sector) {
      for (int i = 0; i < r; ++i) {
        const int outer = sector * r + i;
        const int inner = sector * (r - 1) + i;
        faces.emplace_back(at(r - 1, inner), at(r, outer), at(r, outer + 1));
        if (i + 1 < r) faces.emplace_back(at(r - 1, inner), at(r, outer + 1), at(r - 1, inner + 1));
      }
    }
  }
  return assembled(points, faces);
}

TriangleMesh make_torus(double major, double minor, int nu, int nv) {
  std::vector<Eigen::RowVector3d> points;
  std::vector<Eigen::RowVector3i> faces;
  for (int u = 0; u < nu; ++u) {
    for (int v = 0; v < nv; ++v) {
      const double around = kTau * u / nu;
      const double tube = kTau * v / nv;
      const double radius = major + minor * std::cos(tube);
      points.emplace_back(radius * std::cos(around), radius * std::sin(around),
                          minor * std::sin(tube));
    }
  }
  const auto at = [&](int u, int v) { return (u % nu) * nv + v % nv; };
  for (int u = 0; u < nu; ++u) {
    for (int v = 0; v < nv; ++v) {
      faces.emplace_back(at(u, v), at(u + 1, v), at(u + 1, v + 1));
      faces.emplace_back(at(u, v), at(u + 1, v + 1), at(u, v + 1));
    }
  }
  return assembled(points, faces);
}

TriangleMesh make_cylinder(double height, int nu, int nv) {
  std::vector<Eigen::RowVector3d> points;
  std::vector<Eigen::RowVector3i> faces;
  for (int v = 0; v < nv; ++v) {
    for (int u = 0; u < nu; ++u) {
      const double angle = kTau * (u + 0.5 * (v % 2)) / nu;
      points.emplace_back(std::sin(angle), height * v / (nv - 1), std::cos(angle));
    }
  }
  const auto at = [&](int u, int v) { return v * nu + u % nu; };
  for (int v = 0; v + 1 < nv; ++v) {
    for (int u = 0; u < nu; ++u) {
      // Rows are turned by half a step by turns.
      const bool even = v % 2 == 0;
      faces.emplace_back(at(u, v), at(u + 1, v), at(even ? u : u + 1, v + 1));
      faces.emplace_back(at(even ? u + 1 : u, v), at(u + 1, v + 1), at(u, v + 1));
    }
  }
  return assembled(points, faces);
}

TriangleMesh make_ellipsoid(double a, double b, double c, int frequency) {
  TriangleMesh mesh = make_sphere(frequency);
  mesh.vertices *= Eigen::Vector3d(a, b, c).asDiagonal();
  return mesh;
}

IntrinsicMesh make_flat_torus(int n) {
  IntrinsicMesh torus;
  const Eigen::Index cells = Eigen::Index{n} * n;
  torus.vertices = cells;
  torus.faces.resize(2 * cells, 3);
  torus.lengths.resize(2 * cells, 3);
  const double side = 1.0 / n;
  const double diagonal = std::sqrt(2.0) * side;
  const auto at = [n](int i, int j) { return (i % n) * n + j % n; };
  Eigen::Index f = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      torus.faces.row(f) << at(i, j), at(i + 1, j), at(i + 1, j + 1);
      torus.lengths.row(f++) << side, diagonal, side;
      torus.faces.row(f) << at(i, j), at(i + 1, j + 1), at(i, j + 1);
      torus.lengths.row(f++) << side, side, diagonal;
    }
  }
  return torus;
}

}  // namespace timbre
