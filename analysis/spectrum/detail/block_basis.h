#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "timbre/analysis/spectrum/detail/aligned_array.h"
#include "timbre/analysis/spectrum/detail/block_kernels.h"
#include "timbre/analysis/spectrum/detail/block_mass.h"

namespace timbre::detail {

/// A square of the block width; row i, column j belongs to columns i and j of two blocks.
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Cholesky factor of a Gram matrix, G = R^T R with R upper triangular.
struct BlockFactor {
  Square R;
  double smallest_pivot = 0.0;  ///< beside the diagonal of G; small: nearly dependent
};

/// Where columns depend on those before, to rounding, their rest is lost in G. There R has a row of
/// the identity: the column is freed of those before, but keeps its scale, so that another Gram
/// matrix sees what it is.
///
/// @param gram   U^T M U, whose symmetric part counts
/// @param least  norms at or below which the rest of a column is nothing: R has a row of 0
[[nodiscard]] BlockFactor factorize_gram(const Square& gram, const Eigen::VectorXd& least);

/// Blocks of vectors, size x width each, and the products that a block Krylov method in the M
/// inner product makes of them. Memory is what they cost, so that what can be done with some rows
/// in cache is one pass. Sums run over fixed pieces of the rows in a fixed order, whatever the
/// number of threads.
class BlockBasis {
 public:
  /// @param mass     must outlive this
  /// @param width    8 or 16
  /// @param threads  0: all cores
  BlockBasis(const BlockMass& mass, int width, InstructionSet instructions, int threads);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int blocks() const { return used_; }
  [[nodiscard]] std::size_t numbers() const;  ///< in a block
  [[nodiscard]] const double* block(int j) const { return place(j); }

  /// Where the next block is to be written, and what makes it part of the basis.
  [[nodiscard]] double* next();
  void append_next() { ++used_; }
  void clear() { used_ = 0; }  ///< keeps the memory

  void copy(const double* from, double* to) const;

  /// U -= V_j C for the last block but one, if there is one; then A = Z^T U.
  [[nodiscard]] Square subtract_last_but_one(const Square& C, const double* Z, double* U) const;
  /// U -= V_j A for the last block; then H = V^T M U as of `products`.
  [[nodiscard]] Square subtract_last(const Square& A, double* U, int first);
  /// H = V^T M U for the blocks [first, blocks()): one square for each, below each other.
  [[nodiscard]] Square products(const double* U, int first);
  /// U -= V H, with H as `products` gives it; then G = U^T M U.
  [[nodiscard]] Square subtract(const Square& H, double* U, int first);
  /// Cholesky QR: U := U R^-1 with R from `factorize_gram`, and columns of 0 where it has rows of
  /// 0; then Z = M U.
  [[nodiscard]] BlockFactor orthonormalize(const Square& G, const Eigen::VectorXd& least, double* U,
                                           double* Z) const;

 private:
  // Some rows, that stay in cache while all blocks pass by.
  struct Rows {
    int begin;
    int count;
  };

  static std::size_t at(int j) { return static_cast<std::size_t>(j); }
  [[nodiscard]] const double* place(int j) const {
    return slabs_[at(j / kBlocksInSlab)].data() + at(j % kBlocksInSlab) * numbers();
  }
  [[nodiscard]] std::size_t offset(Rows rows) const { return at(rows.begin) * at(width_); }
  [[nodiscard]] const double* after(int j, int first, Rows rows) const;
  void add_products(const double* Z, int first, Rows rows, double* H) const;
  void subtract_multiples(const double* H, int first, Rows rows, double* U) const;
  template <typename Visit>
  void for_each_chunk(Visit visit) const;
  template <typename Add>
  [[nodiscard]] Square sum(Eigen::Index height, Add add) const;
  template <typename Change, typename Add>
  [[nodiscard]] Square change_and_sum(const double* U, Eigen::Index height, Change change, Add add);

  const BlockMass& mass_;
  int width_;
  int threads_;
  const BlockKernels& kernels_;
  // Blocks lie in slabs of several, so that hardly any of them begins or ends inside a large page.
  static constexpr int kBlocksInSlab = 8;
  std::vector<AlignedArray> slabs_;
  int used_ = 0;
  AlignedArray mass_times_;  // a block, where M is not diagonal
};

}  // namespace timbre::detail
