#include "timbre/analysis/spectrum/detail/constants.h"

#include <cmath>

namespace timbre::detail {

void put_constants(const Eigen::SparseMatrix<double>& M, PairWindow& pairs, Eigen::Index first,
                   Eigen::Index count) {
  const double entry = 1.0 / std::sqrt(M.sum());
  const Eigen::VectorXd mass_constant = M * Eigen::VectorXd::Constant(M.rows(), entry);
  auto vectors = pairs.vectors(first, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    vectors.col(i).array() -= entry * mass_constant.dot(vectors.col(i));
  }
  if (first > 0 || count == 0) return;
  pairs.value(0) = 0.0;
  vectors.col(0).setConstant(entry);
}

}  // namespace timbre::detail
