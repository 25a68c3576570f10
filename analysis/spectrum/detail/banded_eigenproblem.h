#pragma once

#include <Eigen/Core>

namespace timbre::detail {

/// A symmetric block tridiagonal matrix that grows by blocks, as band storage: its lower part,
/// column-major, `width` diagonals below the main one.
class BandedMatrix {
 public:
  explicit BandedMatrix(int width) : width_(width) {}

  [[nodiscard]] int size() const { return static_cast<int>(band_.cols()); }
  void clear() { band_.resize(width_ + 1, 0); }
  /// One more block row.
  ///
  /// @param coupling  R of the last block: the square left of the diagonal one, upper triangular;
  ///                  not looked at for the first
  /// @param diagonal  symmetric
  template <typename Square>
  void append(const Square& coupling, const Square& diagonal) {
    const int before = size();
    band_.conservativeResize(width_ + 1, before + width_);
    band_.rightCols(width_).setZero();
    for (int j = 0; j < width_; ++j) {
      for (int i = j; i < width_; ++i) band_(i - j, before + j) = diagonal(i, j);
      if (before == 0) continue;
      // Row before + i, column before - width + j, of an upper triangle: i <= j.
      for (int i = 0; i <= j; ++i) band_(width_ + i - j, before - width_ + j) = coupling(i, j);
    }
  }
  [[nodiscard]] const Eigen::MatrixXd& band() const { return band_; }
  [[nodiscard]] int width() const { return width_; }

 private:
  int width_;
  Eigen::MatrixXd band_;
};

struct BandedEigenpairs {
  Eigen::VectorXd values;   ///< ascending
  Eigen::MatrixXd vectors;  ///< orthonormal columns
};

/// All eigenpairs, by LAPACK's divide and conquer.
/// @throws Error  not_converged if LAPACK fails
[[nodiscard]] BandedEigenpairs solve(const BandedMatrix& matrix);

}  // namespace timbre::detail
