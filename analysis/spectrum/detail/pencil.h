#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <vector>

namespace timbre::detail {

constexpr int kPencilWidth = 8;  ///< columns that `eigenpair_rests` takes at once

/// Two symmetric matrices K and M on one pattern, for the family K - s M: the lower triangles,
/// in compressed columns with ascending rows. Every diagonal entry is there.
struct Pencil {
  int size = 0;
  std::vector<std::int64_t> start;  ///< size + 1: column j holds [start[j], start[j + 1])
  std::vector<int> row;
  std::vector<double> k;  ///< values of K
  std::vector<double> m;  ///< values of M; 0 where only K has an entry

  [[nodiscard]] std::int64_t entries() const { return start.back(); }
};

/// Unites the patterns of two square matrices of one size, of which the lower triangles are
/// read. Cost: one pass over the entries.
///
/// @throws Error  bad_request if a matrix is not square, or the sizes differ
[[nodiscard]] Pencil make_pencil(const Eigen::SparseMatrix<double>& K,
                                 const Eigen::SparseMatrix<double>& M);

/// The pencil P K P^T - s P M P^T, where row i of it is row `order[i]` of the given one.
///
/// @param order  a permutation of 0 ... size - 1
[[nodiscard]] Pencil permuted(const Pencil& pencil, const std::vector<int>& order);

/// Y = (K - s M) X.
///
/// @param X  size x width, row-major
/// @param Y  size x width, row-major; not X
void multiply(const Pencil& pencil, double shift, const double* X, int width, double* Y);

/// R = K X - M X diag(values): what is left of eigenpairs.
///
/// @param X       size x kPencilWidth, row-major
/// @param values  kPencilWidth
/// @param R       size x kPencilWidth, row-major; not X
void eigenpair_rests(const Pencil& pencil, const double* values, const double* X, double* R);

/// For each row the largest |K - s M| in it: the scale to which its pivot is compared.
[[nodiscard]] std::vector<double> row_scales(const Pencil& pencil, double shift);

}  // namespace timbre::detail
