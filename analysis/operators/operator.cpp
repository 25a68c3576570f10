#include "timbre/analysis/operators/operator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/mesh/sides.h"
#include "timbre/analysis/operators/detail/dirichlet.h"
#include "timbre/analysis/operators/detail/lagrange_basis.h"
#include "timbre/analysis/operators/detail/linear_elements.h"
#include "timbre/analysis/operators/detail/robust.h"
#include "timbre/analysis/operators/detail/surface.h"
#include "timbre/analysis/operators/detail/symmetric_matrix.h"
#include "timbre/analysis/operators/finite_elements.h"

namespace timbre {
namespace {

using detail::MatrixPair;
using detail::MetricFace;
using detail::Surface;
using Eigen::Index;
using Eigen::VectorXd;

// A mesh as each kind of operator may need it.
struct Input {
  const Faces& faces;
  const Points* positions = nullptr;  ///< null: lengths only
  const Surface& surface;
};

struct Matrices {
  SparseMatrix stiffness;
  SparseMatrix mass;
  VectorXd lumped_mass;
  std::int64_t flips = 0;
};

// Sparse matrices are swapped: Eigen's copy where they are moved.
Matrices with_diagonal_mass(SparseMatrix&& stiffness, const VectorXd& diagonal) {
  Matrices found{{}, detail::symmetric_matrix({}, diagonal), diagonal, 0};
  found.stiffness.swap(stiffness);
  return found;
}

// Linear elements on triangles that may be others than the mesh's.
// @param share  of each triangle that counts
Matrices linear_elements(const Surface& surface, std::vector<MatrixPair> weights,
                         const std::vector<MetricFace>& faces, double share, MassKind mass) {
  const VectorXd areas = share * detail::barycentric_areas(surface, faces);
  if (mass == MassKind::lumped) {
    return with_diagonal_mass(detail::laplacian_of_edges(std::move(weights), surface.vertices()),
                              areas);
  }
  std::vector<MatrixPair> pairs = detail::galerkin_pairs(surface, faces);
  for (MatrixPair& pair : pairs) pair.value *= share;
  return {detail::laplacian_of_edges(std::move(weights), surface.vertices()),
          detail::symmetric_matrix(pairs, 0.5 * areas), areas, 0};
}

Matrices cotan_matrices(const Surface& surface, MassKind mass) {
  return linear_elements(surface, detail::cotangent_weights(surface.faces), surface.faces, 1.0,
                         mass);
}

Matrices robust_matrices(const Input& input, MassKind mass) {
  detail::DelaunayElements elements = detail::delaunay_elements(input.surface, input.positions);
  Matrices found = linear_elements(input.surface, std::move(elements.weights), elements.faces,
                                   elements.share, mass);
  found.flips = elements.flips;
  return found;
}

// d0' *1 d0 has the half cotangents as its dual edges over edges; *0 are the dual cells.
Matrices dec_matrices(const Surface& surface) {
  return with_diagonal_mass(
      detail::laplacian_of_edges(detail::cotangent_weights(surface.faces), surface.vertices()),
      detail::circumcentric_areas(surface, surface.faces));
}

// Each edge of the mesh once, with weight 1.
std::vector<MatrixPair> unit_edges(const Input& input) {
  std::vector<MatrixPair> edges;
  const std::vector<TriangleSide> sides = sorted_sides(input.faces);
  for (std::size_t i = 0; i < sides.size(); i = end_of_edge(sides, i)) {
    if (input.surface.component[static_cast<std::size_t>(sides[i].low)] < 0) continue;
    edges.push_back({sides[i].low, sides[i].high, 1.0});
  }
  return edges;
}

VectorXd ones_on_surface(const Surface& surface) {
  VectorXd ones(surface.vertices());
  for (Index v = 0; v < ones.size(); ++v) {
    ones[v] = surface.component[static_cast<std::size_t>(v)] < 0 ? 0.0 : 1.0;
  }
  return ones;
}

Matrices graph_matrices(const Input& input, MassKind mass) {
  SparseMatrix stiffness = detail::laplacian_of_edges(unit_edges(input), input.surface.vertices());
  VectorXd diagonal =
      mass == MassKind::degree ? VectorXd(stiffness.diagonal()) : ones_on_surface(input.surface);
  return with_diagonal_mass(std::move(stiffness), diagonal);
}

// The mean of the vertex areas of each component, at its vertices.
VectorXd mean_areas(const Surface& surface, const VectorXd& areas) {
  std::vector<double> sum(surface.scales.size(), 0.0);
  std::vector<double> count(surface.scales.size(), 0.0);
  for (Index v = 0; v < areas.size(); ++v) {
    const std::int32_t c = surface.component[static_cast<std::size_t>(v)];
    if (c < 0) continue;
    sum[static_cast<std::size_t>(c)] += areas[v];
    count[static_cast<std::size_t>(c)] += 1.0;
  }
  VectorXd mean = VectorXd::Zero(areas.size());
  for (Index v = 0; v < areas.size(); ++v) {
    const std::int32_t c = surface.component[static_cast<std::size_t>(v)];
    if (c >= 0) mean[v] = sum[static_cast<std::size_t>(c)] / count[static_cast<std::size_t>(c)];
  }
  return mean;
}

// With w / mean(A_i, A_j) for weights and 1 for mass, both times the mean area: the same
// eigenvalues, and numbers near 1 whatever the unit of length.
Matrices uniform_matrices(const Surface& surface, bool averaged) {
  std::vector<MatrixPair> weights = detail::cotangent_weights(surface.faces);
  const VectorXd areas = detail::barycentric_areas(surface, surface.faces);
  VectorXd mean = mean_areas(surface, areas);
  if (averaged) {
    for (MatrixPair& edge : weights) {
      edge.value *= 2.0 * mean[edge.a] / (areas[edge.a] + areas[edge.b]);
    }
  }
  return with_diagonal_mass(detail::laplacian_of_edges(std::move(weights), surface.vertices()),
                            mean);
}

Matrices polynomial_matrices(const Input& input, const LagrangeNodes& nodes) {
  const detail::ReferenceElement element = detail::reference_element(nodes.degree);
  const VectorXd shares = element.mass.diagonal() / element.mass.trace();
  const Index local_size = nodes.of_face.cols();
  const auto pairs_of_face = static_cast<std::size_t>(local_size * (local_size - 1) / 2);
  std::vector<MatrixPair> weights;
  std::vector<MatrixPair> mass;
  weights.reserve(input.surface.faces.size() * pairs_of_face);
  mass.reserve(input.surface.faces.size() * pairs_of_face);
  VectorXd diagonal = VectorXd::Zero(nodes.size);
  VectorXd lumped = VectorXd::Zero(nodes.size);
  Index row = 0;
  for (const MetricFace& face : input.surface.faces) {
    // Both lists are in the order of the mesh; this one lacks faces of components without area.
    while (!std::equal(face.corner.begin(), face.corner.end(), nodes.faces.row(row).begin())) ++row;
    const double area = detail::true_area(input.surface, face);
    const std::array<double, 3> cotangent =
        detail::cotangents(face.length, detail::triangle_area(face.length));
    const Eigen::MatrixXd stiffness = cotangent[0] * element.stiffness[0] +
                                      cotangent[1] * element.stiffness[1] +
                                      cotangent[2] * element.stiffness[2];
    const auto node = nodes.of_face.row(row++);
    for (Index i = 0; i < local_size; ++i) {
      diagonal[node[i]] += area * element.mass(i, i);
      lumped[node[i]] += area * shares[i];
      for (Index j = 0; j < i; ++j) {
        weights.push_back({node[i], node[j], -stiffness(i, j)});
        mass.push_back({node[i], node[j], area * element.mass(i, j)});
      }
    }
  }
  return {detail::laplacian_of_edges(std::move(weights), nodes.size),
          detail::symmetric_matrix(mass, diagonal), std::move(lumped), 0};
}

MassKind own_mass(OperatorKind kind) {
  switch (kind) {
    case OperatorKind::robust:
    case OperatorKind::cotan:
      return MassKind::lumped;
    case OperatorKind::p2:
    case OperatorKind::p3:
      return MassKind::consistent;
    case OperatorKind::dec:
      return MassKind::circumcentric;
    case OperatorKind::tutte:
      return MassKind::degree;
    default:
      return MassKind::uniform;
  }
}

Matrices matrices_of(const Input& input, OperatorKind kind, MassKind mass,
                     const LagrangeNodes& nodes) {
  switch (kind) {
    case OperatorKind::robust:
      return robust_matrices(input, mass);
    case OperatorKind::cotan:
      return cotan_matrices(input.surface, mass);
    case OperatorKind::p2:
    case OperatorKind::p3:
      return polynomial_matrices(input, nodes);
    case OperatorKind::dec:
      return dec_matrices(input.surface);
    case OperatorKind::graph:
    case OperatorKind::tutte:
      return graph_matrices(input, mass);
    default:
      return uniform_matrices(input.surface, kind == OperatorKind::averaged);
  }
}

// Nodes that are no vertices belong to the component of their triangle.
std::vector<std::int32_t> component_of_nodes(const Surface& surface, const LagrangeNodes& nodes) {
  std::vector<std::int32_t> component = surface.component;
  component.resize(static_cast<std::size_t>(nodes.size), -1);
  for (const auto& face : nodes.of_face.rowwise()) {
    for (const std::int32_t node : face) {
      component[static_cast<std::size_t>(node)] = component[static_cast<std::size_t>(face[0])];
    }
  }
  return component;
}

std::vector<bool> boundary_rows(const Input& input, const LagrangeNodes& nodes) {
  std::vector<bool> on_boundary = detail::boundary_vertices(input.faces, input.surface.vertices());
  if (nodes.degree == 1) return on_boundary;
  on_boundary.resize(static_cast<std::size_t>(nodes.size), false);
  const std::vector<TriangleSide> sides = sorted_sides(nodes.faces);
  const int per_edge = nodes.degree - 1;
  auto node = static_cast<std::size_t>(nodes.vertices);
  for (std::size_t i = 0; i < sides.size();) {
    const std::size_t end = end_of_edge(sides, i);
    for (int step = 0; step < per_edge; ++step) on_boundary[node++] = end - i == 1;
    i = end;
  }
  return on_boundary;
}

void add_up_components(Operator& op) {
  op.component_area =
      VectorXd::Zero(1 + *std::max_element(op.component.begin(), op.component.end()));
  for (std::size_t row = 0; row < op.component.size(); ++row) {
    if (op.component[row] < 0) continue;
    op.component_area[op.component[row]] += op.lumped_mass[static_cast<Index>(row)];
  }
  for (Index c = 0; c < op.component_area.size(); ++c) {
    // Vertices share the area, and the solver divides by it.
    if (op.component_area[c] > 1e-280 && op.component_area[c] < 1e280) continue;
    throw Error(ErrorKind::bad_input, "", "component " + std::to_string(c),
                "its area is beyond the range of a double; scale the mesh to a unit of length "
                "nearer to its size");
  }
  op.has_constants.assign(static_cast<std::size_t>(op.component_area.size()), true);
  op.area = op.component_area.sum();
}

void require_finite(const Operator& op) {
  const auto is_finite = [](const SparseMatrix& matrix) {
    return Eigen::Map<const VectorXd>(matrix.valuePtr(), matrix.nonZeros()).allFinite();
  };
  if (is_finite(op.stiffness) && is_finite(op.mass)) return;
  throw Error(ErrorKind::bad_input, "", "faces",
              "some are too thin for finite weights; try the robust operator");
}

Operator build(const Input& input, const OperatorOptions& options) {
  Operator op;
  op.kind = options.kind;
  op.mass_kind = mass_of(options);
  op.boundary = options.boundary;
  op.vertices = input.surface.vertices();
  op.components_left_out = input.surface.left_out;
  for (const detail::ComponentScale& scale : input.surface.scales) {
    op.mollified_by = std::max(op.mollified_by, std::ldexp(scale.raise, scale.exponent));
  }
  LagrangeNodes nodes;
  nodes.vertices = nodes.size = op.vertices;
  if (op.kind == OperatorKind::p2 || op.kind == OperatorKind::p3) {
    nodes = number_nodes(input.faces, op.vertices, op.kind == OperatorKind::p2 ? 2 : 3);
  }
  Matrices found = matrices_of(input, op.kind, op.mass_kind, nodes);
  op.stiffness.swap(found.stiffness);
  op.mass.swap(found.mass);
  op.lumped_mass = std::move(found.lumped_mass);
  op.flips = found.flips;
  op.component = component_of_nodes(input.surface, nodes);
  add_up_components(op);
  require_finite(op);
  if (op.boundary == BoundaryKind::dirichlet) {
    detail::fix_rows(op, boundary_rows(input, nodes));
  }
  return op;
}

}  // namespace

Operator compute_operator(const TriangleMesh& mesh, const OperatorOptions& options) {
  const Surface surface = detail::make_surface(mesh, options.mollification);
  Operator op = build({mesh.faces, &mesh.vertices, surface}, options);
  if (op.stiffness.rows() == mesh.vertices.rows()) op.positions = mesh.vertices;
  return op;
}

Operator compute_operator(const Faces& faces, const Points& lengths, Index vertices,
                          const OperatorOptions& options) {
  const Surface surface = detail::make_surface(faces, lengths, vertices, options.mollification);
  return build({faces, nullptr, surface}, options);
}

MassKind mass_of(const OperatorOptions& options) {
  const MassKind own = own_mass(options.kind);
  if (!options.mass || *options.mass == own) return own;
  if (own == MassKind::lumped && *options.mass == MassKind::consistent) return *options.mass;
  throw Error(ErrorKind::bad_request, "", "mass",
              std::string(to_word(*options.mass)) + " does not go with the operator " +
                  to_word(options.kind) + ", whose mass is " + to_word(own));
}

int count_zeros(const Operator& op) {
  return static_cast<int>(std::count(op.has_constants.begin(), op.has_constants.end(), true));
}

SparseMatrix symmetrized(const Operator& op) {
  if (op.mass_kind == MassKind::consistent) {
    throw Error(ErrorKind::bad_request, "", "mass", "must be diagonal, not consistent");
  }
  const VectorXd scale = op.lumped_mass.unaryExpr(
      [](double mass) { return mass > 0.0 ? 1.0 / std::sqrt(mass) : 0.0; });
  SparseMatrix found = op.stiffness;
  for (Index column = 0; column < found.outerSize(); ++column) {
    for (SparseMatrix::InnerIterator it(found, column); it; ++it) {
      it.valueRef() *= scale[it.row()] * scale[column];  // to the bit the same both ways
    }
  }
  return found;
}

const char* to_word(OperatorKind kind) {
  switch (kind) {
    case OperatorKind::robust:
      return "robust";
    case OperatorKind::cotan:
      return "cotan";
    case OperatorKind::p2:
      return "p2";
    case OperatorKind::p3:
      return "p3";
    case OperatorKind::dec:
      return "dec";
    case OperatorKind::graph:
      return "graph";
    case OperatorKind::tutte:
      return "tutte";
    case OperatorKind::unweighted:
      return "unweighted";
    case OperatorKind::averaged:
      break;
  }
  return "averaged";
}

const char* to_word(MassKind kind) {
  switch (kind) {
    case MassKind::lumped:
      return "lumped";
    case MassKind::consistent:
      return "consistent";
    case MassKind::circumcentric:
      return "circumcentric";
    case MassKind::uniform:
      return "uniform";
    case MassKind::degree:
      break;
  }
  return "degree";
}

const char* to_word(BoundaryKind kind) {
  return kind == BoundaryKind::neumann ? "neumann" : "dirichlet";
}

}  // namespace timbre
