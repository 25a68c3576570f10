#include "timbre/analysis/operators/components.h"

namespace timbre {

using Eigen::Index;

ComponentRows rows_of_components(const Operator& op) {
  ComponentRows found;
  found.rows.resize(static_cast<std::size_t>(op.component_area.size()));
  found.place.assign(op.component.size(), -1);
  for (std::size_t i = 0; i < op.component.size(); ++i) {
    if (op.component[i] < 0) continue;
    auto& rows = found.rows[static_cast<std::size_t>(op.component[i])];
    found.place[i] = static_cast<std::int32_t>(rows.size());
    rows.push_back(static_cast<std::int32_t>(i));
  }
  return found;
}

SparseMatrix restricted(const SparseMatrix& matrix, const std::vector<std::int32_t>& rows,
                        const std::vector<std::int32_t>& place) {
  const auto n = static_cast<Index>(rows.size());
  SparseMatrix part(n, n);
  Index entries = 0;
  for (const std::int32_t row : rows) entries += matrix.col(row).nonZeros();
  part.reserve(entries);
  for (Index j = 0; j < n; ++j) {
    part.startVec(j);
    for (SparseMatrix::InnerIterator it(matrix, rows[static_cast<std::size_t>(j)]); it; ++it) {
      part.insertBack(place[static_cast<std::size_t>(it.row())], j) = it.value();
    }
  }
  part.finalize();
  return part;
}

}  // namespace timbre
