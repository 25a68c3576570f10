#include "timbre/analysis/spectrum/detail/component_solver.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "timbre/analysis/spectrum/detail/spectrum_slicing.h"

namespace timbre::detail {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kDenseSize = 200;

SparseMatrix restricted(const SparseMatrix& matrix, const std::vector<std::int32_t>& rows,
                        const std::vector<std::int32_t>& local) {
  const auto n = static_cast<Index>(rows.size());
  SparseMatrix part(n, n);
  std::vector<Eigen::Triplet<double>> entries;
  for (Index j = 0; j < n; ++j) {
    for (SparseMatrix::InnerIterator it(matrix, rows[static_cast<std::size_t>(j)]); it; ++it) {
      entries.emplace_back(local[static_cast<std::size_t>(it.row())], j, it.value());
    }
  }
  part.setFromTriplets(entries.begin(), entries.end());
  return part;
}

// With a diagonal mass an ordinary eigenproblem after scaling by its square root.
void solve_dense(Component& component, Index count) {
  const MatrixXd W = component.stiffness;
  if (component.diagonal_mass) {
    const VectorXd scale = component.lumped_mass.cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<MatrixXd> dense(scale.asDiagonal() * W *
                                                        scale.asDiagonal());
    component.values = dense.eigenvalues().head(count);
    component.vectors = scale.asDiagonal() * dense.eigenvectors().leftCols(count);
  } else {
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> dense(W, MatrixXd(component.mass));
    component.values = dense.eigenvalues().head(count);
    component.vectors = dense.eigenvectors().leftCols(count);
  }
}

void sort_pairs(Component& component) {
  const Index k = component.values.size();
  std::vector<Index> order(static_cast<std::size_t>(k));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return component.values[a] < component.values[b]; });
  component.values = VectorXd(component.values(order));
  component.vectors = MatrixXd(component.vectors(Eigen::all, order));
}

// The kernel of W is known: the constants. They replace what the solver found of them, and leave
// the other vectors, which hold a little of them where weights spread over many powers of ten.
void put_exact_zero(Component& component) {
  component.values = component.values.cwiseMax(0.0);
  if (!component.has_constants) return;
  component.values[0] = 0.0;
  const VectorXd constant =
      VectorXd::Constant(component.size(), 1.0 / std::sqrt(component.lumped_mass.sum()));
  const Eigen::RowVectorXd shares = (component.mass * constant).transpose() * component.vectors;
  component.vectors.noalias() -= constant * shares;
  component.vectors.col(0) = constant;
}

}  // namespace

std::vector<Component> split_into_components(const Operator& op) {
  std::vector<Component> components(static_cast<std::size_t>(op.component_area.size()));
  std::vector<std::int32_t> local(op.component.size(), -1);
  for (std::size_t v = 0; v < op.component.size(); ++v) {
    if (op.component[v] < 0) continue;
    auto& vertices = components[static_cast<std::size_t>(op.component[v])].vertices;
    local[v] = static_cast<std::int32_t>(vertices.size());
    vertices.push_back(static_cast<std::int32_t>(v));
  }
  for (std::size_t c = 0; c < components.size(); ++c) {
    Component& part = components[c];
    part.area = op.component_area[static_cast<Index>(c)];
    part.diagonal_mass = op.mass_kind != MassKind::consistent;
    part.has_constants = op.has_constants[c];
    part.stiffness = restricted(op.stiffness, part.vertices, local);
    part.mass = restricted(op.mass, part.vertices, local) / part.area;
    part.lumped_mass = op.lumped_mass(part.vertices) / part.area;
    if (op.positions.rows() > 0) part.positions = op.positions(part.vertices, Eigen::all);
  }
  return components;
}

void solve_lowest(Component& component, Index count, const ComponentSolveOptions& options) {
  const Index n = component.size();
  count = std::min(count, n);
  if (n <= kDenseSize || count > n / 4) {
    if (options.on_solve) options.on_solve(1);
    solve_dense(component, count);
    if (options.on_solve) options.on_solve(1);
  } else {
    SlicedPairs found =
        lowest_pairs(component.stiffness, component.mass, nullptr,
                     {.count = count,
                      .seed = 1 + 1000 * static_cast<std::uint64_t>(options.attempt),
                      .on_solve = options.on_solve});
    component.values = std::move(found.values);
    component.vectors = std::move(found.vectors);
  }
  sort_pairs(component);
  put_exact_zero(component);
}

VectorXd relative_residuals(const Component& component) {
  const MatrixXd mass_vectors = component.mass * component.vectors;
  const MatrixXd errors =
      component.stiffness * component.vectors - mass_vectors * component.values.asDiagonal();
  // A lone constant has no scale of its own; Weyl's density gives it one.
  const double largest = component.values.size() > 1 ? component.values.maxCoeff() : 0.0;
  const double scale = largest > 0.0 ? largest : 4.0 * std::numbers::pi;
  VectorXd residuals(component.values.size());
  for (Index i = 0; i < residuals.size(); ++i) {
    const double error =
        std::sqrt((errors.col(i).array().square() / component.lumped_mass.array()).sum());
    const double norm = std::sqrt(component.vectors.col(i).dot(mass_vectors.col(i)));
    residuals[i] = error / ((component.values[i] + scale) * norm);
  }
  return residuals;
}

}  // namespace timbre::detail
