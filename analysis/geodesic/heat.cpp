#include "timbre/analysis/geodesic/heat.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/threads.h"
#include "timbre/analysis/geodesic/detail/unit_size.h"
#include "timbre/analysis/mesh/sides.h"
#include "timbre/analysis/operators/operator.h"
#include "timbre/analysis/spectrum/factorization.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVector3d;
using Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

// A triangle in its plane: corners at (0, 0), (base, 0) and (x, height), all positive but x.
struct FlatTriangle {
  std::array<std::int32_t, 3> corner{};
  double base = 0.0;
  double x = 0.0;
  double height = 0.0;
};

std::vector<FlatTriangle> flatten(const TriangleMesh& mesh) {
  std::vector<FlatTriangle> triangles;
  triangles.reserve(static_cast<std::size_t>(mesh.faces.rows()));
  for (const auto& face : mesh.faces.rowwise()) {
    const RowVector3d origin = mesh.vertices.row(face[0]);
    const RowVector3d along = mesh.vertices.row(face[1]) - origin;
    const RowVector3d arm = mesh.vertices.row(face[2]) - origin;
    FlatTriangle flat{{face[0], face[1], face[2]}, along.norm(), 0.0, 0.0};
    if (!(flat.base > 0.0)) continue;
    flat.x = arm.dot(along) / flat.base;
    flat.height = along.cross(arm).norm() / flat.base;
    if (flat.height > 0.0) triangles.push_back(flat);
  }
  return triangles;
}

// Square of the mean edge length of each component.
std::vector<double> squared_steps(const TriangleMesh& mesh, const Operator& op) {
  const auto components = static_cast<std::size_t>(op.component_area.size());
  std::vector<double> length(components, 0.0);
  std::vector<double> edges(components, 0.0);
  const std::vector<TriangleSide> sides = sorted_sides(mesh.faces);
  for (std::size_t i = 0; i < sides.size(); i = end_of_edge(sides, i)) {
    const std::size_t c = at(op.component[at(sides[i].low)]);
    length[c] += (mesh.vertices.row(sides[i].low) - mesh.vertices.row(sides[i].high)).norm();
    edges[c] += 1.0;
  }
  for (std::size_t c = 0; c < components; ++c) length[c] = std::pow(length[c] / edges[c], 2.0);
  return length;
}

// M + t W, with t of each component.
SparseMatrix heat_matrix(const Operator& op, const std::vector<double>& time) {
  SparseMatrix matrix = op.stiffness;
  for (Index j = 0; j < matrix.outerSize(); ++j) {
    const std::int32_t c = op.component[static_cast<std::size_t>(j)];
    for (SparseMatrix::InnerIterator it(matrix, j); it; ++it) it.valueRef() *= time[at(c)];
  }
  SparseMatrix mass(matrix.rows(), matrix.cols());
  mass.setIdentity();  // unused vertices
  for (Index j = 0; j < mass.outerSize(); ++j) {
    if (op.component[static_cast<std::size_t>(j)] >= 0) mass.coeffRef(j, j) = op.lumped_mass[j];
  }
  return matrix + mass;
}

// W is singular on each component: a weight on one vertex holds it there. The right-hand sides
// sum to 0, so that the weight carries nothing and the solution is that of W, 0 at the vertex.
SparseMatrix poisson_matrix(const Operator& op) {
  SparseMatrix pin(op.stiffness.rows(), op.stiffness.cols());
  pin.setIdentity();
  std::vector<bool> pinned(static_cast<std::size_t>(op.component_area.size()), false);
  for (Index j = 0; j < pin.outerSize(); ++j) {
    const std::int32_t c = op.component[static_cast<std::size_t>(j)];
    if (c < 0) continue;
    const bool first = !pinned[at(c)];
    pinned[at(c)] = true;
    pin.coeffRef(j, j) = first ? op.stiffness.coeff(j, j) : 0.0;
  }
  return op.stiffness + pin;
}

// The weak divergence of the unit field that points away from the heat.
VectorXd divergence_of_direction(const std::vector<FlatTriangle>& triangles, const VectorXd& heat) {
  VectorXd divergence = VectorXd::Zero(heat.size());
  for (const FlatTriangle& t : triangles) {
    const auto [a, b, c] = t.corner;
    const double along_b = (heat[a] - heat[b]) / t.base;
    const double away = ((heat[a] - heat[c]) - along_b * t.x) / t.height;
    // Far from the source the squares of what is left would be 0.
    const double largest = std::max(std::abs(along_b), std::abs(away));
    if (!(largest > 0.0)) continue;
    const double x = along_b / largest;
    const double y = away / largest;
    const double norm = std::sqrt(x * x + y * y);
    const double at_b = 0.5 * (t.height * x - t.x * y) / norm;
    const double at_c = 0.5 * t.base * y / norm;
    divergence[a] -= at_b + at_c;
    divergence[b] += at_b;
    divergence[c] += at_c;
  }
  return divergence;
}

}  // namespace

struct HeatGeodesics::Impl {
  Impl(const TriangleMesh& mesh, const HeatOptions& options) {
    if (!(options.time_factor >= 0.01 && options.time_factor <= 1e6)) {
      throw Error(ErrorKind::bad_request, "", "time factor", "is not in the range 0.01 to 1e6");
    }
    const detail::UnitSizeMesh sized = detail::at_unit_size(mesh);
    unit = sized.unit;
    const Operator op = compute_operator(sized.mesh, {.kind = OperatorKind::cotan});
    if (op.components_left_out > 0) {
      throw Error(ErrorKind::bad_input, "", "faces",
                  "those of " + std::to_string(op.components_left_out) +
                      " components have no area; use the exact method");
    }
    component = op.component;
    triangles = flatten(sized.mesh);
    std::vector<double> time = squared_steps(sized.mesh, op);
    for (double& t : time) t *= options.time_factor;
    const SingleThreadedBlas one_thread;
    heat.emplace(heat_matrix(op, time));
    poisson.emplace(poisson_matrix(op));
  }

  [[nodiscard]] Index size() const { return static_cast<Index>(component.size()); }

  void require_sources(std::span<const std::int32_t> sources) const {
    for (const std::int32_t v : sources) {
      if (v >= 0 && v < size()) continue;
      throw Error(ErrorKind::bad_request, "", "sources",
                  "vertex " + std::to_string(v) + " does not exist; the mesh has " +
                      std::to_string(size()));
    }
  }

  void require_heat_everywhere(const Eigen::Ref<const VectorXd>& found,
                               std::span<const std::int32_t> sources) const {
    const std::vector<bool> reached = components_of(sources);
    for (Index v = 0; v < size(); ++v) {
      const std::int32_t c = component[static_cast<std::size_t>(v)];
      if (c < 0 || !reached[at(c)] || std::abs(found[v]) > std::numeric_limits<double>::min()) {
        continue;
      }
      throw Error(ErrorKind::not_converged, "", "heat method",
                  "vertex " + std::to_string(v) +
                      " is too many edges from the source; use the exact method, or a larger "
                      "time factor");
    }
  }

  [[nodiscard]] std::vector<bool> components_of(std::span<const std::int32_t> sources) const {
    std::vector<bool> reached(component.size() + 1, false);
    for (const std::int32_t v : sources) {
      if (component[at(v)] >= 0) reached[at(component[at(v)])] = true;
    }
    return reached;
  }

  // In place: the potential to the distance.
  void finish(Eigen::Ref<VectorXd> column, std::span<const std::int32_t> sources) const {
    std::vector<double> sum(component.size() + 1, 0.0);
    std::vector<double> count(component.size() + 1, 0.0);
    for (const std::int32_t v : sources) {
      if (component[at(v)] < 0) continue;
      sum[at(component[at(v)])] += column[v];
      count[at(component[at(v)])] += 1.0;
    }
    for (Index v = 0; v < size(); ++v) {
      const std::int32_t c = component[static_cast<std::size_t>(v)];
      const bool reached = c >= 0 && count[at(c)] > 0.0;
      column[v] = reached ? unit * std::max(column[v] - sum[at(c)] / count[at(c)], 0.0) : kInfinity;
    }
    for (const std::int32_t v : sources) column[v] = 0.0;
  }

  double unit = 1.0;
  std::vector<std::int32_t> component;
  std::vector<FlatTriangle> triangles;
  std::optional<Factorization> heat;
  std::optional<Factorization> poisson;
};

HeatGeodesics::HeatGeodesics(const TriangleMesh& mesh, const HeatOptions& options)
    : impl_(std::make_unique<Impl>(mesh, options)) {}
HeatGeodesics::~HeatGeodesics() = default;
HeatGeodesics::HeatGeodesics(HeatGeodesics&&) noexcept = default;
HeatGeodesics& HeatGeodesics::operator=(HeatGeodesics&&) noexcept = default;

VectorXd HeatGeodesics::distances(std::span<const std::int32_t> sources) {
  const std::vector<std::vector<std::int32_t>> sets = {{sources.begin(), sources.end()}};
  return distances(sets, 1);
}

MatrixXd HeatGeodesics::distances(std::span<const std::vector<std::int32_t>> source_sets,
                                  int threads) {
  const SingleThreadedBlas one_thread;
  const Index count = std::ssize(source_sets);
  for (const auto& sources : source_sets) impl_->require_sources(sources);
  MatrixXd columns(impl_->size(), count);
  const auto set = [&](Index i) -> const std::vector<std::int32_t>& {
    return source_sets[static_cast<std::size_t>(i)];
  };
  constexpr Index kTogether = 32;  // right-hand sides, which the factors take at once
  parallel_for((count + kTogether - 1) / kTogether, threads, [&](std::int64_t chunk) {
    const Index first = chunk * kTogether;
    const Index last = std::min(first + kTogether, count);
    auto some = columns.middleCols(first, last - first);
    some.setZero();
    for (Index i = first; i < last; ++i) {
      for (const std::int32_t v : set(i)) columns(v, i) = 1.0;
    }
    impl_->heat->solve(some);
    for (Index i = first; i < last; ++i) {
      impl_->require_heat_everywhere(columns.col(i), set(i));
      columns.col(i) = divergence_of_direction(impl_->triangles, columns.col(i));
    }
    impl_->poisson->solve(some);
    for (Index i = first; i < last; ++i) impl_->finish(columns.col(i), set(i));
  });
  return columns;
}

}  // namespace timbre
