#pragma once

#include <cstdint>
#include <vector>

#include "timbre/analysis/operators/operator.h"

namespace timbre {

/// Which rows of an operator make up each of its connected components.
struct ComponentRows {
  std::vector<std::vector<std::int32_t>> rows;  ///< of each component, ascending
  std::vector<std::int32_t> place;  ///< N: of each row within its component; -1 without part
};

[[nodiscard]] ComponentRows rows_of_components(const Operator& op);

/// Rows and columns `rows` of a matrix that couples them to no others.
///
/// @param rows   ascending
/// @param place  of each row of the matrix within `rows`
[[nodiscard]] SparseMatrix restricted(const SparseMatrix& matrix,
                                      const std::vector<std::int32_t>& rows,
                                      const std::vector<std::int32_t>& place);

}  // namespace timbre
