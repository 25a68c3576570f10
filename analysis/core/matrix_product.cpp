#include "timbre/analysis/core/matrix_product.h"

#include <cblas.h>

namespace timbre {
namespace {

using Eigen::MatrixXd;
using Eigen::Ref;

MatrixXd product(CBLAS_TRANSPOSE transpose_a, const Ref<const MatrixXd>& A,
                 CBLAS_TRANSPOSE transpose_b, const Ref<const MatrixXd>& B) {
  const Eigen::Index rows = transpose_a == CblasTrans ? A.cols() : A.rows();
  const Eigen::Index inner = transpose_a == CblasTrans ? A.rows() : A.cols();
  const Eigen::Index cols = transpose_b == CblasTrans ? B.rows() : B.cols();
  MatrixXd C = MatrixXd::Zero(rows, cols);
  if (rows == 0 || cols == 0 || inner == 0) return C;
  cblas_dgemm(CblasColMajor, transpose_a, transpose_b, static_cast<int>(rows),
              static_cast<int>(cols), static_cast<int>(inner), 1.0, A.data(),
              static_cast<int>(A.outerStride()), B.data(), static_cast<int>(B.outerStride()), 0.0,
              C.data(), static_cast<int>(rows));
  return C;
}

}  // namespace

MatrixXd product_at_b(const Ref<const MatrixXd>& A, const Ref<const MatrixXd>& B) {
  return product(CblasTrans, A, CblasNoTrans, B);
}

MatrixXd product_a_b(const Ref<const MatrixXd>& A, const Ref<const MatrixXd>& B) {
  return product(CblasNoTrans, A, CblasNoTrans, B);
}

MatrixXd product_a_bt(const Ref<const MatrixXd>& A, const Ref<const MatrixXd>& B) {
  return product(CblasNoTrans, A, CblasTrans, B);
}

void product_a_bt(const RowMatrixXf& A, Eigen::Index first_row, Eigen::Index rows,
                  const RowMatrixXf& B, RowMatrixXf& C) {
  C.resize(rows, B.rows());
  if (C.size() == 0) return;
  cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasTrans, static_cast<int>(rows),
              static_cast<int>(B.rows()), static_cast<int>(A.cols()), 1.0F,
              A.data() + first_row * A.cols(), static_cast<int>(A.cols()), B.data(),
              static_cast<int>(B.cols()), 0.0F, C.data(), static_cast<int>(B.rows()));
}

}  // namespace timbre
