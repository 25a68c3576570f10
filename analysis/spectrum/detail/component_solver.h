#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "timbre/analysis/operators/operator.h"
#include "timbre/analysis/spectrum/detail/pair_check.h"
#include "timbre/analysis/spectrum/detail/pair_window.h"
#include "timbre/analysis/spectrum/detail/spectrum_slicing.h"

namespace timbre::detail {

/// One connected component of a mesh, scaled to unit area. It has one zero eigenvalue, of the
/// constant function, or with a Dirichlet boundary none.
struct Component {
  std::vector<std::int32_t> vertices;  ///< rows of the whole mesh
  SparseMatrix stiffness;
  SparseMatrix mass;
  Eigen::VectorXd lumped_mass;
  Points positions;   ///< of the rows, or empty
  double area = 0.0;  ///< true area; eigenvalues here are `area` times the true ones
  bool diagonal_mass = true;
  bool has_constants = true;

  [[nodiscard]] Eigen::Index size() const { return stiffness.rows(); }
};

[[nodiscard]] std::vector<Component> split_into_components(const Operator& op);

struct ComponentSolveOptions {
  Eigen::Index count = 100;  ///< pairs wanted at first
  double tolerance = 1e-9;   ///< as SlicingOptions has it
  bool certify = true;
  FactorizationBackend backend = FactorizationBackend::automatic;
  bool keep_all = false;  ///< as SlicingOptions has it
  int threads = 1;        ///< 0: all cores. Results do not depend on it
  /// After so many solves with a factor, 0 while it is made; may throw.
  std::function<void(int)> on_solve;
  PhaseClock* clock = nullptr;  ///< must outlive the solver
};

/// The eigenpairs of a component, from the lowest, found little by little and handed on in that
/// order: all at once if it is small, by a dense solver where slicing does not do, else band by
/// band.
class ComponentSolver {
 public:
  ComponentSolver(Component component, const ComponentSolveOptions& options);
  ComponentSolver(const ComponentSolver&) = delete;
  ComponentSolver& operator=(const ComponentSolver&) = delete;

  [[nodiscard]] const Component& component() const { return component_; }

  /// Finds some more pairs; where all that were wanted are known, raises that number first.
  /// Does nothing once all pairs are known.
  /// @throws Error  not_converged
  void advance();

  [[nodiscard]] Eigen::Index certain() const { return certain_; }  ///< pairs known for certain
  /// Exactly `certain()` eigenvalues lie below; infinite when all are known.
  [[nodiscard]] double bound() const { return bound_; }
  [[nodiscard]] bool is_exhausted() const { return certain_ == component_.size(); }

  /// Those not forgotten, up to `certain()`; some may follow.
  [[nodiscard]] const PairWindow& pairs() const { return slicer_ ? slicer_->pairs() : dense_; }
  /// |K x - lambda M x| in the norm of the inverse lumped mass, of a certain pair.
  [[nodiscard]] double error(Eigen::Index pair) const {
    return errors_[static_cast<std::size_t>(pair)];
  }
  /// max |X^T M X - I| of the certain pairs, as OrthonormalityCheck has it.
  [[nodiscard]] double orthonormality() const { return check_.worst(); }
  [[nodiscard]] const std::vector<SliceReport>& slices() const;

  void forget_before(Eigen::Index pair);
  /// Gives the first vectors away, of a solver that has forgotten none, and ends it.
  [[nodiscard]] Eigen::MatrixXd release_vectors(Eigen::Index count);

  /// To or from a StateWriter or StateReader. Dense pairs are not stored but computed again.
  template <typename File>
  void exchange(File& file) {
    exchange_value(file, certain_);
    exchange_value(file, bound_);
    exchange_vector(file, errors_);
    check_.exchange(file);
    bool slices = slicer_.has_value();
    exchange_value(file, slices);
    if (!slices) slicer_.reset();
    if (slicer_) slicer_->exchange(file);
    if (!slicer_ && certain_ > dense_.end()) solve_dense();
  }

 private:
  void slice_all_or_none();
  void solve_dense();
  void take_over(Eigen::Index certain, double bound);

  Component component_;
  PairWindow dense_;
  std::optional<SpectrumSlicer> slicer_;
  OrthonormalityCheck check_;
  int threads_;
  PhaseClock* clock_;
  std::vector<double> errors_;
  Eigen::Index certain_ = 0;
  double bound_ = SlicingState::kNowhere;
};

}  // namespace timbre::detail
