#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstdint>
#include <vector>

#include "timbre/analysis/spectrum/detail/pair_window.h"
#include "timbre/analysis/spectrum/detail/pencil.h"
#include "timbre/analysis/spectrum/detail/state_file.h"

namespace timbre::detail {

/// How far pairs [first, first + count) of a window are from eigenpairs:
/// |K x - lambda M x| in the norm of D^-1, for x of M-norm 1.
///
/// @param pencil  K and M
/// @param order   row i of the pencil is row order[i] of the vectors; empty: the same
/// @param lumped  D, positive, in the order of the vectors
/// @param threads 0: all cores
[[nodiscard]] Eigen::VectorXd pair_errors(const Pencil& pencil, const std::vector<int>& order,
                                          const Eigen::VectorXd& lumped, const PairWindow& pairs,
                                          Eigen::Index first, Eigen::Index count, int threads);

/// Watches that a stream of vectors stays M-orthonormal. Products with those found together and the
/// last ones before are all computed; earlier vectors are looked at through a few sums of all of
/// them with random signs: the root mean square of a vector's products with these sums is, in the
/// mean over signs, the root of the sum of its squared products with each, and so no less than the
/// largest.
class OrthonormalityCheck {
 public:
  /// @param M        must outlive this
  /// @param threads  0: all cores
  OrthonormalityCheck(const Eigen::SparseMatrix<double>& M, int threads);

  /// Looks at pairs [first, first + count), which follow those of the last call, beside each other
  /// and those from `before` on.
  void add(const PairWindow& pairs, Eigen::Index before, Eigen::Index first, Eigen::Index count);

  [[nodiscard]] double worst() const { return worst_; }  ///< max |X^T M X - I| so far

  /// To or from a StateWriter or StateReader.
  template <typename File>
  void exchange(File& file) {
    exchange_value(file, worst_);
    std::uint64_t columns = static_cast<std::uint64_t>(sums_.cols());
    exchange_value(file, columns);
    const auto rows = static_cast<std::size_t>(mass_.rows());
    file.expect(columns);
    file.expect(columns * rows * sizeof(double));
    sums_.resize(mass_.rows(), static_cast<Eigen::Index>(columns));
    file.bytes(sums_.data(), columns * rows * sizeof(double));
  }

 private:
  [[nodiscard]] double worst_of(const PairWindow& pairs, Eigen::Index before, Eigen::Index begin,
                                Eigen::Index count) const;

  const Eigen::SparseMatrix<double>& mass_;
  int threads_;
  double worst_ = 0.0;
  Eigen::MatrixXd sums_;  // of all vectors so far, with random signs
};

}  // namespace timbre::detail
