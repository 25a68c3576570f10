#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <vector>

#include "timbre/analysis/core/progress.h"
#include "timbre/analysis/operators/operator.h"
#include "timbre/analysis/spectrum/detail/component_solver.h"
#include "timbre/analysis/spectrum/detail/phase_clock.h"
#include "timbre/analysis/spectrum/spectrum.h"

namespace timbre::detail {

/// One eigenpair of the union of all components, at true scale.
struct MergedPair {
  double value = 0.0;
  std::size_t component = 0;
  Eigen::Index pair = 0;  ///< of the component
};

/// The eigenpairs of all components in one ascending list, found little by little. A pair is
/// handed on once every component is known up to its eigenvalue.
class MergedPairs {
 public:
  enum class Vectors : std::uint8_t {
    forget,  ///< once they have been handed on
    keep,    ///< to the end, for `release_vectors`
  };
  MergedPairs(const Operator& op, const SpectrumOptions& options, Vectors vectors);

  [[nodiscard]] Eigen::Index wanted() const { return wanted_; }
  [[nodiscard]] Eigen::Index handed_on() const { return std::ssize(handed_on_); }

  /// The pairs that come next: none when all that were wanted have been handed on. Their vectors
  /// stay until the next call, or until they are forgotten.
  /// @throws Error  not_converged, cancelled
  [[nodiscard]] std::vector<MergedPair> next();

  /// What is saved after it holds no vector that was handed on, but a few neighbours.
  void forget_handed_on();

  /// The vectors of all pairs, N x wanted, of which the last has been handed on and none was
  /// forgotten; nothing is left.
  [[nodiscard]] Eigen::MatrixXd release_vectors();

  /// The vector of a pair, on all rows of the operator, with the canonical sign.
  void write_vector(const MergedPair& pair, double* column) const;

  /// After the last pair: all of a Spectrum but the vectors, checked, with a bound if asked for.
  /// Finds more pairs where no gap for a bound is known.
  /// @throws Error  not_converged, cancelled
  [[nodiscard]] Spectrum finish();

  /// To or from a StateWriter or StateReader.
  template <typename File>
  void exchange(File& file) {
    exchange_vector(file, handed_on_);
    exchange_vector(file, handed_on_of_);
    exchange_value(file, solves_);
    for (ComponentSolver& part : components_) part.exchange(file);
  }

 private:
  [[nodiscard]] Certificate certify();
  [[nodiscard]] Eigen::VectorXd residuals() const;
  [[nodiscard]] double orthonormality() const;
  void check(const Spectrum& found) const;
  [[nodiscard]] double horizon() const;
  [[nodiscard]] std::vector<MergedPair> known() const;
  void advance();
  [[nodiscard]] std::vector<InertiaCount> shifts() const;

  SpectrumOptions options_;
  PhaseClock clock_;
  bool forgets_;
  Eigen::Index rows_;
  Eigen::Index wanted_;
  double area_;
  std::deque<ComponentSolver> components_;
  std::vector<MergedPair> handed_on_;
  std::vector<Eigen::Index> handed_on_of_;  // how many of each component
  Eigen::Index expected_solves_;
  Eigen::Index solves_ = 0;
  ProgressReporter reporter_;
};

}  // namespace timbre::detail
