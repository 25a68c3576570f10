#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "timbre/analysis/spectrum/detail/aligned_array.h"
#include "timbre/analysis/spectrum/detail/block_kernels.h"
#include "timbre/analysis/spectrum/detail/pencil.h"

namespace timbre::detail {

/// A square of the block width; row i, column j belongs to columns i and j of two blocks.
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// M of a pencil as it acts on blocks.
class BlockMass {
 public:
  /// @param pencil   must outlive this
  /// @param threads  0: all cores
  BlockMass(const Pencil& pencil, int threads);

  [[nodiscard]] int size() const { return static_cast<int>(diagonal_.size()); }
  [[nodiscard]] double diagonal(int row) const { return diagonal_[static_cast<std::size_t>(row)]; }
  /// Z = M U; both size x width, row-major.
  void multiply(const double* U, int width, double* Z) const;

 private:
  const Pencil* pencil_;
  int threads_;
  std::vector<double> diagonal_;
  bool is_diagonal_ = true;
};

/// What CholeskyQR found. R is upper triangular.
struct BlockFactor {
  Square R;
  double smallest_pivot = 0.0;  ///< beside the diagonal of the Gram matrix; small: nearly dependent
};

/// Blocks of vectors, size x width each, and the products that a block Krylov method makes of
/// them. Sums run over fixed pieces of the rows in a fixed order, whatever the number of threads.
class BlockBasis {
 public:
  /// @param width    8 or 16
  /// @param threads  0: all cores
  BlockBasis(int size, int width, InstructionSet instructions, int threads);

  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int blocks() const { return used_; }
  [[nodiscard]] std::size_t numbers() const;  ///< in a block
  [[nodiscard]] const double* block(int j) const { return place(j); }

  /// Where the next block is to be written, and what makes it part of the basis.
  [[nodiscard]] double* next();
  void append_next() { ++used_; }
  void clear() { used_ = 0; }  ///< keeps the memory

  /// H = V^T Z for the blocks [first, blocks()): one square for each, below each other.
  [[nodiscard]] Square products(const double* Z, int first = 0) const;
  /// U -= V H, with H as `products` gives it.
  void subtract(const Square& H, double* U, int first = 0) const;

  void copy(const double* from, double* to) const;
  /// A^T B of two blocks.
  [[nodiscard]] Square gram(const double* A, const double* B) const;
  /// U -= V H for blocks of any owner.
  void subtract(const double* V, const Square& H, double* U) const;
  /// U := U T and Z := Z T.
  void multiply_right(const Square& T, double* U, double* Z) const;
  /// Cholesky QR: given Z = M U, makes U R^-1 of U and Z R^-1 of Z, for U^T M U = R^T R.
  [[nodiscard]] BlockFactor orthonormalise(double* U, double* Z) const;

 private:
  static std::size_t at(int j) { return static_cast<std::size_t>(j); }
  [[nodiscard]] const double* place(int j) const {
    return slabs_[at(j / kBlocksInSlab)].data() + at(j % kBlocksInSlab) * numbers();
  }
  template <typename Visit>
  void for_each_chunk(Visit visit) const;
  template <typename Add>
  [[nodiscard]] Square sum(Eigen::Index rows, Add add) const;

  int size_;
  int width_;
  int threads_;
  const BlockKernels& kernels_;
  // Blocks lie in slabs of several, so that hardly any of them begins or ends inside a large page.
  static constexpr int kBlocksInSlab = 8;
  std::vector<AlignedArray> slabs_;
  int used_ = 0;
};

}  // namespace timbre::detail
