#pragma once

#include <Eigen/SparseCore>

#include "timbre/analysis/spectrum/detail/pair_window.h"

namespace timbre::detail {

/// Where the constants are the kernel of K they are known beforehand: pair 0 becomes exactly that,
/// and they are taken out of the others, which hold a little of them where weights spread over
/// many powers of ten. Works on pairs [first, first + count).
void put_constants(const Eigen::SparseMatrix<double>& M, PairWindow& pairs, Eigen::Index first,
                   Eigen::Index count);

}  // namespace timbre::detail
