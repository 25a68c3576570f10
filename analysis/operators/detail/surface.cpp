#include "timbre/analysis/operators/detail/surface.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "timbre/analysis/core/disjoint_sets.h"
#include "timbre/analysis/core/error.h"
#include "timbre/analysis/mesh/triangle.h"

namespace timbre::detail {
namespace {

using Eigen::Index;

std::size_t at(Index index) { return static_cast<std::size_t>(index); }

void require_sound(const TriangleMesh& mesh) {
  const Index n = mesh.vertices.rows();
  for (Index v = 0; v < n; ++v) {
    if (mesh.vertices.row(v).allFinite()) continue;
    throw Error(ErrorKind::bad_input, "", "vertex " + std::to_string(v),
                "coordinate is not finite");
  }
  for (Index f = 0; f < mesh.faces.rows(); ++f) {
    for (const std::int32_t corner : mesh.faces.row(f)) {
      if (corner >= 0 && corner < n) continue;
      throw Error(ErrorKind::bad_input, "", "face " + std::to_string(f),
                  "index " + std::to_string(corner) + " is out of range, the mesh has " +
                      std::to_string(n) + " vertices");
    }
  }
}

// Lengths in units of 2^exponent. A power of two costs no digit, and differences of
// coordinates are taken first: neither an extreme unit nor a far origin is felt.
struct ScaledLengths {
  Points lengths;
  int exponent = 0;
};

double length_of(const Eigen::RowVector3d& edge) {
  constexpr double kSmall = 1e-140;  // below it, squares have lost digits
  const double length = edge.norm();
  return length > kSmall ? length : edge.stableNorm();
}

ScaledLengths edge_lengths(const TriangleMesh& mesh) {
  double largest = 0.0;  // of vertices in use: one that is not must not set the unit
  for (const std::int32_t v : mesh.faces.reshaped()) {
    largest = std::max(largest, mesh.vertices.row(v).cwiseAbs().maxCoeff());
  }
  ScaledLengths scaled{Points(mesh.faces.rows(), 3), largest > 0.0 ? std::ilogb(largest) : 0};
  const int exponent = scaled.exponent;
  const Points points =
      mesh.vertices.unaryExpr([exponent](double x) { return std::ldexp(x, -exponent); });
  for (Index f = 0; f < mesh.faces.rows(); ++f) {
    for (int c = 0; c < 3; ++c) {
      const Eigen::RowVector3d edge =
          points.row(mesh.faces(f, (c + 1) % 3)) - points.row(mesh.faces(f, (c + 2) % 3));
      scaled.lengths(f, c) = length_of(edge);
    }
  }
  return scaled;
}

// Faces with three different corners, and whether each has area.
struct SoundFaces {
  std::vector<MetricFace> faces;
  std::vector<bool> has_area;
};

// @param has_area  of a row of `faces`
template <typename HasArea>
SoundFaces sound_faces(const Faces& faces, const Points& lengths, const HasArea& has_area) {
  SoundFaces kept;
  kept.faces.reserve(static_cast<std::size_t>(faces.rows()));
  for (Index f = 0; f < faces.rows(); ++f) {
    const auto [a, b, c] = std::array{faces(f, 0), faces(f, 1), faces(f, 2)};
    if (a == b || b == c || c == a) continue;
    kept.faces.push_back({{a, b, c}, {lengths(f, 0), lengths(f, 1), lengths(f, 2)}});
    kept.has_area.push_back(has_area(f));
  }
  if (kept.faces.empty()) {
    throw Error(ErrorKind::bad_input, "", "faces",
                faces.rows() == 0
                    ? "there are none, only points; a Laplacian needs a surface"
                    : "none with three different corners; a Laplacian needs at least one");
  }
  return kept;
}

// Labels components by their first vertex, and drops those without area with their faces.
void label_components(Surface& surface, const std::vector<bool>& has_area, Index n) {
  DisjointSets sets(static_cast<std::size_t>(n));
  for (const MetricFace& face : surface.faces) {
    for (const std::size_t c : {1U, 2U}) sets.join(face.corner[0], face.corner[c]);
  }
  std::vector<bool> root_has_area(static_cast<std::size_t>(n), false);
  std::vector<bool> is_root(static_cast<std::size_t>(n), false);
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const std::size_t root = at(sets.root(surface.faces[f].corner[0]));
    is_root[root] = true;
    if (has_area[f]) root_has_area[root] = true;
  }
  surface.component.assign(static_cast<std::size_t>(n), -1);
  std::int32_t count = 0;
  for (std::size_t v = 0; v < surface.component.size(); ++v) {
    const std::size_t root = at(sets.root(static_cast<std::int32_t>(v)));
    if (!root_has_area[root]) {
      if (is_root[v]) ++surface.left_out;
      continue;
    }
    if (root == v) surface.component[v] = count++;
    surface.component[v] = surface.component[root];
  }
  if (count == 0) {
    throw Error(ErrorKind::bad_input, "", "faces",
                "none has any area; a Laplacian needs at least one that has");
  }
  std::erase_if(surface.faces,
                [&](const MetricFace& face) { return surface.component[at(face.corner[0])] < 0; });
  surface.scales.resize(at(count));
}

// @param exponent  lengths count in units of 2^exponent
void scale_components(Surface& surface, int exponent) {
  const auto label = [&](const MetricFace& face) {
    return at(surface.component[at(face.corner[0])]);
  };
  std::vector<double> longest(surface.scales.size(), 0.0);
  for (const MetricFace& face : surface.faces) {
    double& own = longest[label(face)];
    own = std::max({own, face.length[0], face.length[1], face.length[2]});
  }
  std::vector<int> own_exponent(longest.size());
  for (std::size_t c = 0; c < longest.size(); ++c) {
    own_exponent[c] = std::ilogb(longest[c]);
    surface.scales[c].exponent = own_exponent[c] + exponent;
  }
  std::vector<double> edges(longest.size(), 0.0);
  for (MetricFace& face : surface.faces) {
    const std::size_t c = label(face);
    for (double& length : face.length) {
      length = std::ldexp(length, -own_exponent[c]);
      surface.scales[c].mean_length += length;
      edges[c] += 1.0;
    }
  }
  for (std::size_t c = 0; c < edges.size(); ++c) surface.scales[c].mean_length /= edges[c];
}

// Adds to all lengths of a component what its thinnest triangle needs to keep its slack.
// All lengths, because raising some would break the inequality in others.
void mollify(Surface& surface, double relative_slack) {
  const auto scale_of = [&](const MetricFace& face) -> ComponentScale& {
    return surface.scales[at(surface.component[at(face.corner[0])])];
  };
  for (const MetricFace& face : surface.faces) {
    ComponentScale& own = scale_of(face);
    const double longest = *std::max_element(face.length.begin(), face.length.end());
    const double others = face.length[0] + face.length[1] + face.length[2] - longest;
    own.raise = std::max(own.raise, relative_slack * own.mean_length + longest - others);
  }
  for (MetricFace& face : surface.faces) {
    for (double& length : face.length) length += scale_of(face).raise;
  }
}

Surface make_scaled(SoundFaces sound, int exponent, Index vertices, double mollification) {
  if (!(mollification >= 0.0)) {
    throw Error(ErrorKind::bad_request, "", "mollification", "must be 0 or more");
  }
  Surface surface;
  surface.faces = std::move(sound.faces);
  label_components(surface, sound.has_area, vertices);
  scale_components(surface, exponent);
  mollify(surface, mollification);
  return surface;
}

}  // namespace

Surface make_surface(const TriangleMesh& mesh, double mollification) {
  require_sound(mesh);
  const ScaledLengths scaled = edge_lengths(mesh);
  const double per_unit = 1.0 / unit_of({mesh.vertices.data(), at(mesh.vertices.size())});
  const auto has_area = [&](Index f) {
    const auto corner = [&](Index c) { return mesh.vertices.row(mesh.faces(f, c)).data(); };
    // All lengths are 0 where a part is beyond the range of a double smaller than the whole.
    return scaled.lengths.row(f).maxCoeff() > 0.0 &&
           !has_no_area(corner(0), corner(1), corner(2), per_unit);
  };
  return make_scaled(sound_faces(mesh.faces, scaled.lengths, has_area), scaled.exponent,
                     mesh.vertices.rows(), mollification);
}

Surface make_surface(const Faces& faces, const Points& lengths, Index vertices,
                     double mollification) {
  const auto has_area = [&](Index f) {
    return triangle_area({lengths(f, 0), lengths(f, 1), lengths(f, 2)}) > 0.0;
  };
  return make_scaled(sound_faces(faces, lengths, has_area), 0, vertices, mollification);
}

double triangle_area(std::array<double, 3> length) {
  std::sort(length.begin(), length.end(), std::greater<>());
  const auto [a, b, c] = length;
  const double product = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
  return 0.25 * std::sqrt(std::max(product, 0.0));
}

std::array<double, 3> cotangents(const std::array<double, 3>& length, double area) {
  std::array<double, 3> cotangent{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double left = length[(c + 1) % 3];
    const double right = length[(c + 2) % 3];
    cotangent[c] = ((left - length[c]) * (left + length[c]) + right * right) / (4.0 * area);
  }
  return cotangent;
}

}  // namespace timbre::detail
