#include "timbre/matching/surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/threads.h"
#include "timbre/analysis/operators/operator.h"
#include "timbre/matching/detail/stages.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kLeastVertices = 30;

void require_request_makes_sense(const SurfaceOptions& options) {
  detail::require_at_least("eigenpairs", options.eigenpairs, 8);
  detail::require_at_least("samples", options.samples, kLeastVertices);
  detail::require_at_least("geodesic_samples", options.geodesic_samples, kLeastVertices);
  detail::require_at_least("tensor_size", options.tensor_size, 3);
}

struct Component {
  TriangleMesh mesh;
  std::vector<std::int32_t> vertex;  ///< file index of each row
  double share = 1.0;                ///< of the whole area
};

Component largest_component(const TriangleMesh& mesh, const Operator& op) {
  Component part;
  Index largest = 0;
  part.share = op.component_area.maxCoeff(&largest) / op.area;
  std::vector<std::int32_t> row(op.component.size(), -1);
  for (std::size_t v = 0; v < op.component.size(); ++v) {
    if (op.component[v] != largest) continue;
    row[v] = static_cast<std::int32_t>(part.vertex.size());
    part.vertex.push_back(static_cast<std::int32_t>(v));
  }
  part.mesh.vertices = mesh.vertices(part.vertex, Eigen::all);
  std::vector<Index> kept;
  for (Index f = 0; f < mesh.faces.rows(); ++f) {
    const Eigen::RowVector3i c = mesh.faces.row(f);
    const bool repeated = c[0] == c[1] || c[1] == c[2] || c[2] == c[0];
    if (!repeated && row[static_cast<std::size_t>(c[0])] >= 0) kept.push_back(f);
  }
  part.mesh.faces = mesh.faces(kept, Eigen::all);
  for (std::int32_t& corner : part.mesh.faces.reshaped()) {
    corner = row[static_cast<std::size_t>(corner)];
  }
  return part;
}

Points vertex_normals(const Points& points, const Faces& faces) {
  Points normals = Points::Zero(points.rows(), 3);
  for (Index f = 0; f < faces.rows(); ++f) {
    const Eigen::RowVector3d a = points.row(faces(f, 0));
    const Eigen::RowVector3d b = points.row(faces(f, 1));
    const Eigen::RowVector3d c = points.row(faces(f, 2));
    const Eigen::RowVector3d normal = (b - a).cross(c - a);
    for (int corner = 0; corner < 3; ++corner) normals.row(faces(f, corner)) += normal;
  }
  for (auto row : normals.rowwise()) row /= row.norm() + 1e-15;
  return normals;
}

double quantile(std::vector<double> values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

// Mean curvature along the normal, clipped where the mesh makes it wild, with mean 0 and
// unit norm, as coefficients. On a flat shape there is none, and the result is 0.
VectorXd curvature_coefficients(const MatchSurface& s, const SparseMatrix& stiffness) {
  const Points laplacian = stiffness * s.points;
  VectorXd h = 0.5 * laplacian.cwiseProduct(s.normals).rowwise().sum().cwiseQuotient(s.mass);
  const std::vector<double> all(h.begin(), h.end());
  h = h.cwiseMax(quantile(all, 0.02)).cwiseMin(quantile(all, 0.98));
  h.array() -= s.mass.dot(h);
  const double norm = std::sqrt(s.mass.dot(h.cwiseAbs2()));
  if (norm < 1e-9) return VectorXd::Zero(s.vectors.cols());
  return s.vectors.transpose() * s.mass.cwiseProduct(h) / norm;
}

// All products of two of the first functions after the constant, a column each.
MatrixXd pair_columns(const MatrixXd& left, const MatrixXd& right) {
  const Index k = left.cols();
  MatrixXd pairs(left.rows(), k * k);
  for (Index i = 0; i < k; ++i) {
    for (Index j = 0; j < k; ++j) pairs.col(i * k + j) = left.col(i).cwiseProduct(right.col(j));
  }
  return pairs;
}

Tensor3 slices(const MatrixXd& flat, Index k) {
  Tensor3 tensor;
  for (Index i = 0; i < k; ++i) tensor.emplace_back(flat.middleRows(i * k, k));
  return tensor;
}

constexpr Index kBlock = 4096;  // rows whose pairs are held at a time

Tensor3 product_tensor(const MatrixXd& phi, const VectorXd& mass) {
  const Index k = phi.cols();
  MatrixXd sum = MatrixXd::Zero(k * k, k);
  for (Index first = 0; first < phi.rows(); first += kBlock) {
    const auto rows = Eigen::seqN(first, std::min(kBlock, phi.rows() - first));
    const MatrixXd part = phi(rows, Eigen::all);
    sum += product_at_b(pair_columns(part, part), mass(rows).asDiagonal() * part);
  }
  return slices(sum, k);
}

// dphi_i ^ dphi_j is constant on a triangle, phi_k enters by its mean there.
Tensor3 area_tensor(const MatrixXd& phi, const Faces& faces) {
  const Index k = phi.cols();
  MatrixXd sum = MatrixXd::Zero(k * k, k);
  for (Index first = 0; first < faces.rows(); first += kBlock) {
    const auto rows = Eigen::seqN(first, std::min(kBlock, faces.rows() - first));
    const Faces part = faces(rows, Eigen::all);
    const MatrixXd base = phi(Eigen::VectorXi(part.col(0)), Eigen::all);
    const MatrixXd e1 = phi(Eigen::VectorXi(part.col(1)), Eigen::all) - base;
    const MatrixXd e2 = phi(Eigen::VectorXi(part.col(2)), Eigen::all) - base;
    const MatrixXd mean = base + (e1 + e2) / 3.0;
    sum += product_at_b(0.5 * (pair_columns(e1, e2) - pair_columns(e2, e1)), mean);
  }
  return slices(sum, k);
}

void compute_tensors(MatchSurface& s, Index k) {
  const MatrixXd phi = s.vectors.middleCols(1, k);
  s.products = product_tensor(phi, s.mass);
  // A one-sided surface has no area form.
  s.areas = s.orientation == Orientation::none
                ? Tensor3(static_cast<std::size_t>(k), MatrixXd::Zero(k, k))
                : area_tensor(phi, s.faces);
}

// Geodesic farthest points, then Euclidean ones, which cost less and fill the gaps.
void choose_samples(MatchSurface& s, const SurfaceOptions& options) {
  Index first = 0;
  s.points.rowwise().squaredNorm().maxCoeff(&first);
  s.samples =
      geodesic_farthest_points(s.graph, options.geodesic_samples, static_cast<std::int32_t>(first));
  s.distances = graph_distance_rows(s.graph, s.samples, options.threads);

  VectorXd nearest = s.distances.colwise().minCoeff().transpose().cast<double>();
  const Index wanted = std::min<Index>(options.samples, s.points.rows());
  while (static_cast<Index>(s.samples.size()) < wanted) {
    Index farthest = 0;
    nearest.maxCoeff(&farthest);
    s.samples.push_back(static_cast<std::int32_t>(farthest));
    const Eigen::RowVector3d at = s.points.row(farthest);
    nearest = nearest.cwiseMin((s.points.rowwise() - at).rowwise().norm());
    nearest[farthest] = -1.0;  // never twice, not even among coincident vertices
  }

  s.sample_mass = VectorXd::Constant(s.distances.rows(), 1e-9);
  for (Index v = 0; v < s.points.rows(); ++v) {
    Index cell = 0;
    s.distances.col(v).minCoeff(&cell);
    s.sample_mass[cell] += s.mass[v];
  }
}

MatchSurface prepared(const TriangleMesh& mesh, const Operator& op, Spectrum spectrum,
                      const SurfaceOptions& options) {
  MatchSurface s;
  OrientedFaces oriented = orient_outward(mesh);
  s.faces = std::move(oriented.faces);
  s.orientation = oriented.orientation;
  s.area = op.area;
  spectrum = at_unit_area(std::move(spectrum), op.area);
  s.values = std::move(spectrum.values);
  s.vectors = std::move(spectrum.vectors);
  s.mass = op.lumped_mass / op.area;
  s.points = mesh.vertices / std::sqrt(op.area);
  s.points.rowwise() -= (s.mass.transpose() * s.points).eval();
  s.normals = vertex_normals(s.points, s.faces);
  s.graph = make_geodesic_graph({s.points, s.faces});
  s.curvature = curvature_coefficients(s, op.stiffness);
  compute_tensors(s, std::min<Index>(options.tensor_size, s.values.size() - 1));
  choose_samples(s, options);
  return s;
}

}  // namespace

MatchSurface prepare_surface(const TriangleMesh& mesh, const SurfaceOptions& options) {
  require_request_makes_sense(options);
  const SingleThreadedBlas blas;
  const Component part = largest_component(mesh, compute_operator(mesh));
  const Index n = part.mesh.vertices.rows();
  if (n < kLeastVertices) {
    throw Error(ErrorKind::bad_input, "", "mesh",
                "its largest component has " + std::to_string(n) + " vertices; matching needs " +
                    std::to_string(kLeastVertices));
  }
  const Operator op = compute_operator(part.mesh);
  MatchSurface s = prepared(part.mesh, op,
                            compute_spectrum(op, {.count = options.eigenpairs,
                                                  .threads = options.threads,
                                                  .progress = options.progress}),
                            options);
  s.vertex = part.vertex;
  s.file_vertices = mesh.vertices.rows();
  s.component_share = part.share;
  return s;
}

MatchSurface prepare_surface(const TriangleMesh& mesh, Spectrum spectrum,
                             const SurfaceOptions& options) {
  require_request_makes_sense(options);
  const SingleThreadedBlas blas;
  const Operator op = compute_operator(mesh);
  const Index n = mesh.vertices.rows();
  if (op.component_area.size() != 1 || op.lumped_mass.minCoeff() <= 0.0) {
    throw Error(ErrorKind::bad_request, "", "mesh",
                "has several components or unused vertices; they cannot share a spectrum here");
  }
  if (spectrum.vectors.rows() != n || n < kLeastVertices || spectrum.values.size() < 8) {
    throw Error(ErrorKind::bad_request, "", "spectrum",
                "is of " + std::to_string(spectrum.vectors.rows()) + " vertices, the mesh has " +
                    std::to_string(n) + "; matching needs " + std::to_string(kLeastVertices) +
                    " and 8 eigenpairs");
  }
  MatchSurface s = prepared(mesh, op, std::move(spectrum), options);
  s.vertex.resize(static_cast<std::size_t>(n));
  std::iota(s.vertex.begin(), s.vertex.end(), 0);
  s.file_vertices = n;
  return s;
}

}  // namespace timbre
