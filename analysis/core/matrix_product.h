#pragma once

#include <Eigen/Core>

namespace timbre {

using RowMatrixXf = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Products of large dense matrices, by BLAS: it chooses kernels for the processor at run
// time, which templates compiled for a portable baseline cannot.

/// A^T B.
[[nodiscard]] Eigen::MatrixXd product_at_b(const Eigen::Ref<const Eigen::MatrixXd>& A,
                                           const Eigen::Ref<const Eigen::MatrixXd>& B);

/// A B.
[[nodiscard]] Eigen::MatrixXd product_a_b(const Eigen::Ref<const Eigen::MatrixXd>& A,
                                          const Eigen::Ref<const Eigen::MatrixXd>& B);

/// A B^T.
[[nodiscard]] Eigen::MatrixXd product_a_bt(const Eigen::Ref<const Eigen::MatrixXd>& A,
                                           const Eigen::Ref<const Eigen::MatrixXd>& B);

/// C = A B^T for `rows` rows of A from `first_row` on; single precision, row-major.
void product_a_bt(const RowMatrixXf& A, Eigen::Index first_row, Eigen::Index rows,
                  const RowMatrixXf& B, RowMatrixXf& C);

}  // namespace timbre
