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

// Positions near 1, so that no product over- or underflows: divided by 2^exponent,
// which costs no digit, and taken from the centre of the box.
struct ScaledPoints {
  Points points;
  int exponent = 0;
};

ScaledPoints scale_points(const Points& vertices) {
  ScaledPoints scaled;
  const double largest = vertices.size() > 0 ? vertices.cwiseAbs().maxCoeff() : 0.0;
  if (largest == 0.0) {
    scaled.points = vertices;
    return scaled;
  }
  const int far = std::ilogb(largest);
  const auto shrink = [](int exponent) {
    return [exponent](double x) { return std::ldexp(x, -exponent); };
  };
  Points points = vertices.unaryExpr(shrink(far));
  const Eigen::RowVector3d low = points.colwise().minCoeff();
  const Eigen::RowVector3d high = points.colwise().maxCoeff();
  points.rowwise() -= 0.5 * (low + high);
  const double extent = (high - low).maxCoeff();
  const int near = extent > 0.0 ? std::ilogb(extent) : 0;
  scaled.points = points.unaryExpr(shrink(near));
  scaled.exponent = far + near;
  return scaled;
}

Points edge_lengths(const Faces& faces, const Points& points) {
  Points lengths(faces.rows(), 3);
  for (Index f = 0; f < faces.rows(); ++f) {
    for (int c = 0; c < 3; ++c) {
      lengths(f, c) =
          (points.row(faces(f, (c + 1) % 3)) - points.row(faces(f, (c + 2) % 3))).norm();
    }
  }
  return lengths;
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

// Adds to all lengths of a component what its thinnest triangle needs to keep its slack.
// All lengths, because raising some would break the inequality in others; by component,
// because a small one beside a large one has a unit of length of its own.
double mollify(std::vector<IntrinsicFace>& faces, const std::vector<std::int32_t>& component,
               double relative_slack) {
  const auto count =
      static_cast<std::size_t>(1 + *std::max_element(component.begin(), component.end()));
  const auto of = [&](const IntrinsicFace& face) {
    return static_cast<std::size_t>(component[static_cast<std::size_t>(face.corner[0])]);
  };
  std::vector<double> mean(count, 0.0);
  std::vector<double> edges(count, 0.0);
  for (const IntrinsicFace& face : faces) {
    mean[of(face)] += face.length[0] + face.length[1] + face.length[2];
    edges[of(face)] += 3.0;
  }
  for (std::size_t c = 0; c < count; ++c) {
    mean[c] /= edges[c];
    if (mean[c] > 0.0) continue;
    throw Error(
        ErrorKind::bad_input, "", "faces",
        "no face of component " + std::to_string(c) + " has area; a Laplacian needs at least one");
  }
  std::vector<double> raise(count, 0.0);
  for (const IntrinsicFace& face : faces) {
    const double longest = std::max({face.length[0], face.length[1], face.length[2]});
    const double others = face.length[0] + face.length[1] + face.length[2] - longest;
    raise[of(face)] = std::max(raise[of(face)], relative_slack * mean[of(face)] + longest - others);
  }
  for (IntrinsicFace& face : faces) {
    for (double& length : face.length) length += raise[of(face)];
  }
  return *std::max_element(raise.begin(), raise.end());
}

// Heron's formula in Kahan's order, which keeps its digits on needles.
double triangle_area(std::array<double, 3> length) {
  std::sort(length.begin(), length.end(), std::greater<>());
  const auto [a, b, c] = length;
  const double product = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
  return 0.25 * std::sqrt(std::max(product, 0.0));
}

struct Assembly {
  std::vector<Triplet> weights;     ///< (i < j, half the cotangents)
  std::vector<Triplet> mass_pairs;  ///< (i < j), consistent mass only
  Eigen::VectorXd lumped;
};

Assembly assemble(const std::vector<IntrinsicFace>& faces, Index vertices, MassKind mass) {
  Assembly sums;
  sums.lumped = Eigen::VectorXd::Zero(vertices);
  sums.weights.reserve(3 * faces.size());
  for (const IntrinsicFace& face : faces) {
    const double area = triangle_area(face.length);
    for (std::size_t c = 0; c < 3; ++c) {
      const double opposite = face.length[c];
      const double left = face.length[(c + 1) % 3];
      const double right = face.length[(c + 2) % 3];
      const double cotangent =
          ((left - opposite) * (left + opposite) + right * right) / (4.0 * area);
      const auto [i, j] = std::minmax(face.corner[(c + 1) % 3], face.corner[(c + 2) % 3]);
      sums.weights.emplace_back(i, j, 0.5 * cotangent);
      if (mass == MassKind::consistent) sums.mass_pairs.emplace_back(i, j, area / 12.0);
      sums.lumped[face.corner[c]] += area / 3.0;
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

// @param exponent  lengths count in units of 2^exponent
Operator build(std::vector<IntrinsicFace> faces, Index n, int exponent,
               const OperatorOptions& options) {
  Operator op;
  op.component = label_components(faces, n);
  const double raised = mollify(faces, op.component, options.mollification);
  const Assembly sums = assemble(faces, n, options.mass);
  op.kind = options.kind;
  op.mass_kind = options.mass;
  op.mollified_by = std::ldexp(raised, exponent);
  op.stiffness = stiffness_of(sums.weights, n);
  const double unit = std::ldexp(1.0, 2 * exponent);
  op.mass = mass_of(sums, options.mass, n) * unit;
  op.lumped_mass = sums.lumped * unit;
  if (!op.lumped_mass.allFinite() || !(op.lumped_mass.maxCoeff() > 1e-290)) {
    throw Error(ErrorKind::bad_input, "", "vertices",
                "the area is beyond the range of a double; scale the mesh to a unit of length "
                "nearer to its size");
  }
  const auto components = *std::max_element(op.component.begin(), op.component.end()) + 1;
  op.component_area = Eigen::VectorXd::Zero(components);
  for (Index v = 0; v < n; ++v) {
    const std::int32_t c = op.component[static_cast<std::size_t>(v)];
    if (c >= 0) op.component_area[c] += op.lumped_mass[v];
  }
  op.area = op.component_area.sum();
  return op;
}

}  // namespace

Operator compute_operator(const TriangleMesh& mesh, const OperatorOptions& options) {
  const ScaledPoints scaled = scale_points(mesh.vertices);
  return build(intrinsic_faces(mesh.faces, edge_lengths(mesh.faces, scaled.points)),
               mesh.vertices.rows(), scaled.exponent, options);
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
