#include "timbre/analysis/spectrum/detail/component_solver.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/operators/components.h"
#include "timbre/analysis/spectrum/detail/constants.h"

namespace timbre::detail {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kDenseSize = 200;       // and below: dense
constexpr Index kSmallSize = 1000;      // and below: dense if more than a quarter is wanted
constexpr Index kGeometricCount = 300;  // and below: an ordering that is found fast pays

bool suits_dense(Index n, Index count) {
  return n <= kDenseSize || (n <= kSmallSize && count > n / 4);
}

}  // namespace

std::vector<Component> split_into_components(const Operator& op) {
  ComponentRows of_components = rows_of_components(op);
  std::vector<Component> components(of_components.rows.size());
  for (std::size_t c = 0; c < components.size(); ++c) {
    Component& part = components[c];
    part.vertices = std::move(of_components.rows[c]);
    part.area = op.component_area[static_cast<Index>(c)];
    part.diagonal_mass = op.mass_kind != MassKind::consistent;
    part.has_constants = op.has_constants[c];
    part.stiffness = restricted(op.stiffness, part.vertices, of_components.place);
    part.mass = restricted(op.mass, part.vertices, of_components.place);
    part.mass /= part.area;
    part.lumped_mass = op.lumped_mass(part.vertices) / part.area;
    if (op.positions.rows() > 0) part.positions = op.positions(part.vertices, Eigen::all);
  }
  return components;
}

ComponentSolver::ComponentSolver(Component component, const ComponentSolveOptions& options)
    : component_(std::move(component)),
      dense_(component_.size()),
      check_(component_.mass, options.threads),
      threads_(options.threads),
      clock_(options.clock) {
  if (suits_dense(component_.size(), options.count)) return;
  const bool by_positions = options.count <= kGeometricCount && component_.positions.rows() > 0;
  slicer_.emplace(component_.stiffness, component_.mass,
                  by_positions ? &component_.positions : nullptr,
                  SlicingOptions{.count = options.count,
                                 .tolerance = options.tolerance,
                                 .certify = options.certify,
                                 .has_constants = component_.has_constants,
                                 .backend = options.backend,
                                 .keep_all = options.keep_all,
                                 .threads = options.threads,
                                 .on_solve = options.on_solve,
                                 .clock = options.clock});
}

// A Krylov method finds little room in a small space where many pairs lie close together. Slicing
// is tried first: it keeps more digits of small eigenvalues beside large ones.
void ComponentSolver::slice_all_or_none() {
  try {
    while (!slicer_->is_done()) slicer_->advance();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::not_converged) throw;
    slicer_.reset();
  }
}

void ComponentSolver::advance() {
  if (is_exhausted()) return;
  if (slicer_ && certain_ == 0 && component_.size() <= kSmallSize) {
    slice_all_or_none();
    if (slicer_) return take_over(slicer_->state().certain, slicer_->state().bound);
  }
  if (!slicer_) {
    solve_dense();
    return take_over(component_.size(), std::numeric_limits<double>::infinity());
  }
  if (slicer_->is_done()) slicer_->want(certain_ + std::max<Index>(20, certain_ / 4));
  slicer_->advance();
  take_over(slicer_->state().certain, slicer_->state().bound);
}

void ComponentSolver::take_over(Index certain, double bound) {
  const PhaseClock::Scope phase(clock_, &SpectrumPhases::checks);
  const Index fresh = certain - certain_;
  static const std::vector<int> as_given;
  const Pencil own = slicer_ ? Pencil{} : make_pencil(component_.stiffness, component_.mass);
  const VectorXd errors = pair_errors(slicer_ ? slicer_->factor().pencil() : own,
                                      slicer_ ? slicer_->factor().order() : as_given,
                                      component_.lumped_mass, pairs(), certain_, fresh, threads_);
  errors_.insert(errors_.end(), errors.begin(), errors.end());
  const Index before = std::max(pairs().first(), certain_ - SpectrumSlicer::kNeighbours);
  check_.add(pairs(), before, certain_, fresh);
  certain_ = certain;
  bound_ = bound;
}

// With a diagonal mass an ordinary eigenproblem after scaling by its square root. The kernel of W
// is known: the constants.
void ComponentSolver::solve_dense() {
  const MatrixXd W = component_.stiffness;
  const Index n = component_.size();
  dense_.append(n);
  auto vectors = dense_.vectors(0, n);
  VectorXd values;
  if (component_.diagonal_mass) {
    const VectorXd scale = component_.lumped_mass.cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<MatrixXd> dense(scale.asDiagonal() * W *
                                                        scale.asDiagonal());
    values = dense.eigenvalues();
    vectors = scale.asDiagonal() * dense.eigenvectors();
  } else {
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> dense(W, MatrixXd(component_.mass));
    values = dense.eigenvalues();
    vectors = dense.eigenvectors();
  }
  for (Index i = 0; i < n; ++i) dense_.value(i) = std::max(values[i], 0.0);
  if (component_.has_constants) put_constants(component_.mass, dense_, 0, n);
}

Eigen::MatrixXd ComponentSolver::release_vectors(Index count) {
  return slicer_ ? slicer_->release_vectors(count) : dense_.release(count);
}

void ComponentSolver::forget_before(Index pair) {
  slicer_ ? slicer_->forget_before(pair) : dense_.drop_before(pair);
}

const std::vector<SliceReport>& ComponentSolver::slices() const {
  static const std::vector<SliceReport> none;
  return slicer_ ? slicer_->state().slices : none;
}

}  // namespace timbre::detail
