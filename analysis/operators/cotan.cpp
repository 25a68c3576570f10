#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/operators/operator.h"

namespace timbre {
namespace {

using Eigen::Index;
using Triplet = Eigen::Triplet<double>;

struct IntrinsicFace {
  std::array<std::int32_t, 3> corner{};
  std::array<double, 3> length{};  ///< length[c] lies opposite corner[c]
};

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
      scaled.lengths(f, c) =
          (points.row(mesh.faces(f, (c + 1) % 3)) - points.row(mesh.faces(f, (c + 2) % 3))).norm();
    }
  }
  return scaled;
}

// Faces with a repeated corner are no part of a surface.
std::vector<IntrinsicFace> intrinsic_faces(const Faces& faces, const Points& lengths) {
  std::vector<IntrinsicFace> kept;
  kept.reserve(static_cast<std::size_t>(faces.rows()));
  for (Index f = 0; f < faces.rows(); ++f) {
    const auto [a, b, c] = std::array{faces(f, 0), faces(f, 1), faces(f, 2)};
    if (a == b || b == c || c == a) continue;
    kept.push_back({{a, b, c}, {lengths(f, 0), lengths(f, 1), lengths(f, 2)}});
  }
  if (kept.empty()) {
    throw Error(ErrorKind::bad_input, "", "faces",
                "none with three different corners; a Laplacian needs at least one");
  }
  return kept;
}

std::int32_t find_root(std::vector<std::int32_t>& parent, std::int32_t v) {
  while (parent[static_cast<std::size_t>(v)] != v) {
    auto& up = parent[static_cast<std::size_t>(v)];
    up = parent[static_cast<std::size_t>(up)];
    v = up;
  }
  return v;
}

// The component of each vertex, numbered by first vertex; -1 for vertices in no face.
std::vector<std::int32_t> label_components(const std::vector<IntrinsicFace>& faces, Index n) {
  std::vector<std::int32_t> parent(static_cast<std::size_t>(n));
  std::iota(parent.begin(), parent.end(), 0);
  std::vector<bool> used(static_cast<std::size_t>(n), false);
  for (const IntrinsicFace& face : faces) {
    used[static_cast<std::size_t>(face.corner[0])] = true;
    for (const std::size_t c : {1U, 2U}) {
      used[static_cast<std::size_t>(face.corner[c])] = true;
      const std::int32_t a = find_root(parent, face.corner[0]);
      const std::int32_t b = find_root(parent, face.corner[c]);
      parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }
  }
  std::vector<std::int32_t> label(static_cast<std::size_t>(n), -1);
  std::int32_t count = 0;
  for (std::size_t v = 0; v < label.size(); ++v) {
    if (!used[v]) continue;
    const auto root = static_cast<std::size_t>(find_root(parent, static_cast<std::int32_t>(v)));
    if (root == v) label[v] = count++;
    label[v] = label[root];
  }
  return label;
}

// Heron's formula in Kahan's order, which keeps its digits on needles.
double triangle_area(std::array<double, 3> length) {
  std::sort(length.begin(), length.end(), std::greater<>());
  const auto [a, b, c] = length;
  const double product = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
  return 0.25 * std::sqrt(std::max(product, 0.0));
}

// A connected component and its own unit of length: one far smaller than another
// neither underflows beside it nor is mollified by the other's measure.
struct ComponentScale {
  int exponent = 0;  ///< lengths here count in units of 2^exponent
  double mean_length = 0.0;
  double edges = 0.0;
  double area = 0.0;
  double raise = 0.0;  ///< added to each length
};

std::vector<ComponentScale> scale_components(std::vector<IntrinsicFace>& faces,
                                             const std::vector<std::int32_t>& component) {
  std::vector<ComponentScale> scales(
      static_cast<std::size_t>(1 + *std::max_element(component.begin(), component.end())));
  const auto of = [&](const IntrinsicFace& face) -> ComponentScale& {
    return scales[static_cast<std::size_t>(component[static_cast<std::size_t>(face.corner[0])])];
  };
  std::vector<double> longest(scales.size(), 0.0);
  for (const IntrinsicFace& face : faces) {
    double& own = longest[static_cast<std::size_t>(&of(face) - scales.data())];
    own = std::max({own, face.length[0], face.length[1], face.length[2]});
  }
  for (std::size_t c = 0; c < scales.size(); ++c) {
    if (longest[c] > 0.0) scales[c].exponent = std::ilogb(longest[c]);
  }
  for (IntrinsicFace& face : faces) {
    ComponentScale& own = of(face);
    for (double& length : face.length) {
      length = std::ldexp(length, -own.exponent);
      own.mean_length += length;
      own.edges += 1.0;
    }
    own.area += triangle_area(face.length);
  }
  for (std::size_t c = 0; c < scales.size(); ++c) {
    scales[c].mean_length /= scales[c].edges;
    if (scales[c].area > 0.0) continue;
    throw Error(
        ErrorKind::bad_input, "", "faces",
        "no face of component " + std::to_string(c) + " has area; a Laplacian needs at least one");
  }
  return scales;
}

// Adds to all lengths of a component what its thinnest triangle needs to keep its slack.
// All lengths, because raising some would break the inequality in others.
void mollify(std::vector<IntrinsicFace>& faces, const std::vector<std::int32_t>& component,
             double relative_slack, std::vector<ComponentScale>& scales) {
  const auto of = [&](const IntrinsicFace& face) -> ComponentScale& {
    return scales[static_cast<std::size_t>(component[static_cast<std::size_t>(face.corner[0])])];
  };
  for (const IntrinsicFace& face : faces) {
    ComponentScale& own = of(face);
    const double longest = std::max({face.length[0], face.length[1], face.length[2]});
    const double others = face.length[0] + face.length[1] + face.length[2] - longest;
    own.raise = std::max(own.raise, relative_slack * own.mean_length + longest - others);
  }
  for (IntrinsicFace& face : faces) {
    for (double& length : face.length) length += of(face).raise;
  }
}

struct Assembly {
  std::vector<Triplet> weights;     ///< (i < j, half the cotangents)
  std::vector<Triplet> mass_pairs;  ///< (i < j), consistent mass only
  Eigen::VectorXd lumped;
};

// @param exponent  lengths of component c count in units of 2^(scales[c].exponent + exponent)
Assembly assemble(const std::vector<IntrinsicFace>& faces, const Operator& op,
                  const std::vector<ComponentScale>& scales, int exponent, MassKind mass) {
  const auto vertices = static_cast<Index>(op.component.size());
  Assembly sums;
  sums.lumped = Eigen::VectorXd::Zero(vertices);
  sums.weights.reserve(3 * faces.size());
  for (const IntrinsicFace& face : faces) {
    const double area = triangle_area(face.length);
    const auto component =
        static_cast<std::size_t>(op.component[static_cast<std::size_t>(face.corner[0])]);
    const double true_area = std::ldexp(area, 2 * (scales[component].exponent + exponent));
    for (std::size_t c = 0; c < 3; ++c) {
      const double opposite = face.length[c];
      const double left = face.length[(c + 1) % 3];
      const double right = face.length[(c + 2) % 3];
      const double cotangent =
          ((left - opposite) * (left + opposite) + right * right) / (4.0 * area);
      const auto [i, j] = std::minmax(face.corner[(c + 1) % 3], face.corner[(c + 2) % 3]);
      sums.weights.emplace_back(i, j, 0.5 * cotangent);
      if (mass == MassKind::consistent) sums.mass_pairs.emplace_back(i, j, true_area / 12.0);
      sums.lumped[face.corner[c]] += true_area / 3.0;
    }
  }
  return sums;
}

SparseMatrix symmetric(const std::vector<Triplet>& pairs, Index n) {
  SparseMatrix upper(n, n);
  upper.setFromTriplets(pairs.begin(), pairs.end());
  return SparseMatrix(upper.transpose()) + upper;
}

SparseMatrix diagonal(const Eigen::VectorXd& entries) {
  std::vector<Triplet> triplets;
  for (Index i = 0; i < entries.size(); ++i) {
    if (entries[i] != 0.0) triplets.emplace_back(i, i, entries[i]);
  }
  SparseMatrix matrix(entries.size(), entries.size());
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

// Each edge is summed once and used for (i,j), (j,i) and both diagonals: W is
// symmetric to the bit, and its rows add up to 0 up to the rounding of one sum.
SparseMatrix stiffness_of(const std::vector<Triplet>& weights, Index n) {
  const SparseMatrix off = symmetric(weights, n);
  const Eigen::VectorXd sums = off * Eigen::VectorXd::Ones(n);
  SparseMatrix stiffness = diagonal(sums) - off;
  stiffness.makeCompressed();
  return stiffness;
}

SparseMatrix mass_of(const Assembly& sums, MassKind kind, Index n) {
  if (kind == MassKind::lumped) return diagonal(sums.lumped);
  SparseMatrix mass = diagonal(0.5 * sums.lumped) + symmetric(sums.mass_pairs, n);
  mass.makeCompressed();
  return mass;
}

void require_areas(const Operator& op) {
  for (Index c = 0; c < op.component_area.size(); ++c) {
    // Vertices share the area, and the solver divides by it.
    if (op.component_area[c] > 1e-280 && op.component_area[c] < 1e280) continue;
    throw Error(ErrorKind::bad_input, "", "component " + std::to_string(c),
                "its area is beyond the range of a double; scale the mesh to a unit of length "
                "nearer to its size");
  }
}

// @param exponent  lengths count in units of 2^exponent
Operator build(std::vector<IntrinsicFace> faces, Index n, int exponent,
               const OperatorOptions& options) {
  if (!(options.mollification >= 0.0)) {
    throw Error(ErrorKind::bad_request, "", "mollification", "must be 0 or more");
  }
  Operator op;
  op.component = label_components(faces, n);
  std::vector<ComponentScale> scales = scale_components(faces, op.component);
  mollify(faces, op.component, options.mollification, scales);
  const Assembly sums = assemble(faces, op, scales, exponent, options.mass);
  op.kind = options.kind;
  op.mass_kind = options.mass;
  for (const ComponentScale& scale : scales) {
    op.mollified_by = std::max(op.mollified_by, std::ldexp(scale.raise, scale.exponent + exponent));
  }
  op.stiffness = stiffness_of(sums.weights, n);
  op.mass = mass_of(sums, options.mass, n);
  op.lumped_mass = sums.lumped;
  op.component_area = Eigen::VectorXd::Zero(static_cast<Index>(scales.size()));
  for (Index v = 0; v < n; ++v) {
    const std::int32_t c = op.component[static_cast<std::size_t>(v)];
    if (c >= 0) op.component_area[c] += op.lumped_mass[v];
  }
  op.area = op.component_area.sum();
  require_areas(op);
  return op;
}

}  // namespace

Operator compute_operator(const TriangleMesh& mesh, const OperatorOptions& options) {
  require_sound(mesh);
  const ScaledLengths scaled = edge_lengths(mesh);
  return build(intrinsic_faces(mesh.faces, scaled.lengths), mesh.vertices.rows(), scaled.exponent,
               options);
}

Operator compute_operator(const Faces& faces, const Points& lengths, Index vertices,
                          const OperatorOptions& options) {
  return build(intrinsic_faces(faces, lengths), vertices, 0, options);
}

const char* to_word(OperatorKind kind) {
  switch (kind) {
    case OperatorKind::cotan:
      break;
  }
  return "cotan";
}

const char* to_word(MassKind kind) { return kind == MassKind::lumped ? "lumped" : "consistent"; }

}  // namespace timbre
