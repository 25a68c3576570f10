#pragma once

#include <cstddef>
#include <vector>

#include "timbre/analysis/spectrum/detail/pencil.h"

namespace timbre::detail {

/// M of a pencil as it acts on blocks of vectors, size x width and row-major.
class BlockMass {
 public:
  /// @param pencil   must outlive this
  /// @param threads  0: all cores
  BlockMass(const Pencil& pencil, int threads);

  [[nodiscard]] int size() const { return static_cast<int>(diagonal_.size()); }
  [[nodiscard]] double diagonal(int row) const { return diagonal_[static_cast<std::size_t>(row)]; }
  /// Then a row of M U needs one row of U only.
  [[nodiscard]] bool is_diagonal() const { return is_diagonal_; }

  /// Z = M U.
  void multiply(const double* U, int width, double* Z) const;
  /// The same for rows [begin, begin + rows), of a diagonal M; Z holds these rows only.
  void multiply_rows(const double* U, int begin, int rows, int width, double* Z) const;

 private:
  const Pencil* pencil_;
  int threads_;
  std::vector<double> diagonal_;
  bool is_diagonal_ = true;
};

}  // namespace timbre::detail
