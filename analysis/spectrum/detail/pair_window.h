#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "timbre/analysis/spectrum/detail/state_file.h"

namespace timbre::detail {

/// The latest of a growing list of eigenpairs, numbered from 0, in ascending order. Those before
/// `first()` have been handed on and are not kept.
class PairWindow {
 public:
  /// @param rows  of a vector
  explicit PairWindow(Eigen::Index rows) : rows_(rows) {}

  [[nodiscard]] Eigen::Index rows() const { return rows_; }
  [[nodiscard]] Eigen::Index first() const { return first_; }
  [[nodiscard]] Eigen::Index end() const { return first_ + std::ssize(values_); }

  [[nodiscard]] double& value(Eigen::Index i) { return values_[at(i)]; }
  [[nodiscard]] double value(Eigen::Index i) const { return values_[at(i)]; }
  /// Columns [i, i + count) as a rows x count matrix.
  [[nodiscard]] Eigen::Map<Eigen::MatrixXd> vectors(Eigen::Index i, Eigen::Index count) {
    return {column(i), rows_, count};
  }
  [[nodiscard]] Eigen::Map<const Eigen::MatrixXd> vectors(Eigen::Index i,
                                                          Eigen::Index count) const {
    return {column(i), rows_, count};
  }
  [[nodiscard]] double* column(Eigen::Index i) {
    return vectors_.data() + static_cast<std::ptrdiff_t>(at(i)) * rows_;
  }
  [[nodiscard]] const double* column(Eigen::Index i) const {
    return vectors_.data() + static_cast<std::ptrdiff_t>(at(i)) * rows_;
  }

  /// Takes the memory for so many vectors at once.
  void reserve(Eigen::Index count);
  /// Adds pairs with values and vectors still to be written.
  void append(Eigen::Index count);
  /// Forgets pairs from `end` on.
  void truncate(Eigen::Index end) { values_.resize(at(end)); }
  /// Forgets pairs before `first`, where there are any.
  void drop_before(Eigen::Index first);
  /// Gives the first `count` vectors away, of a window that has dropped none; nothing is left.
  [[nodiscard]] Eigen::MatrixXd release(Eigen::Index count);

  /// To or from a StateWriter or StateReader.
  template <typename File>
  void exchange(File& file) {
    exchange_value(file, first_);
    exchange_vector(file, values_);
    const std::size_t bytes = values_.size() * static_cast<std::size_t>(rows_) * sizeof(double);
    file.expect(bytes);
    if (vectors_.cols() < std::ssize(values_)) grow(std::ssize(values_));
    file.bytes(vectors_.data(), bytes);
  }

 private:
  void grow(Eigen::Index columns);
  [[nodiscard]] std::size_t at(Eigen::Index i) const {
    return static_cast<std::size_t>(i - first_);
  }

  Eigen::Index rows_;
  Eigen::Index first_ = 0;
  std::vector<double> values_;
  Eigen::MatrixXd vectors_;  // `rows_` x values, with room for more
};

}  // namespace timbre::detail
