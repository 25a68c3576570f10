#include "timbre/analysis/operators/detail/symmetric_matrix.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace timbre::detail {
namespace {

using Eigen::Index;

struct Entry {
  std::int32_t row = 0;
  std::int32_t column = 0;
  double value = 0.0;
};

// Stable, by `key(entry)` in [0, n): two rounds sort entries by column, and by row within.
template <typename Key>
std::vector<Entry> sorted_by(const std::vector<Entry>& entries, Index n, Key key) {
  std::vector<std::size_t> place(static_cast<std::size_t>(n) + 1, 0);
  for (const Entry& entry : entries) ++place[static_cast<std::size_t>(key(entry)) + 1];
  std::partial_sum(place.begin(), place.end(), place.begin());
  std::vector<Entry> sorted(entries.size());
  for (const Entry& entry : entries) sorted[place[static_cast<std::size_t>(key(entry))]++] = entry;
  return sorted;
}

std::vector<Entry> all_entries(const std::vector<MatrixPair>& pairs,
                               const Eigen::VectorXd& diagonal) {
  std::vector<Entry> entries;
  entries.reserve(2 * pairs.size() + static_cast<std::size_t>(diagonal.size()));
  for (Index i = 0; i < diagonal.size(); ++i) {
    const auto row = static_cast<std::int32_t>(i);
    if (diagonal[i] != 0.0) entries.push_back({row, row, diagonal[i]});
  }
  for (const MatrixPair& pair : pairs) {
    entries.push_back({pair.a, pair.b, pair.value});
    if (pair.a != pair.b) entries.push_back({pair.b, pair.a, pair.value});
  }
  return entries;
}

// Entries of equal place stand together and become one.
void add_up(std::vector<Entry>& entries) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (kept > 0 && entries[kept - 1].row == entries[i].row &&
        entries[kept - 1].column == entries[i].column) {
      entries[kept - 1].value += entries[i].value;
    } else {
      entries[kept++] = entries[i];
    }
  }
  entries.resize(kept);
}

}  // namespace

SparseMatrix symmetric_matrix(const std::vector<MatrixPair>& pairs,
                              const Eigen::VectorXd& diagonal) {
  const Index n = diagonal.size();
  std::vector<Entry> entries = all_entries(pairs, diagonal);
  entries = sorted_by(entries, n, [](const Entry& entry) { return entry.row; });
  entries = sorted_by(entries, n, [](const Entry& entry) { return entry.column; });
  add_up(entries);

  SparseMatrix matrix(n, n);
  matrix.resizeNonZeros(static_cast<Index>(entries.size()));
  auto* const starts = matrix.outerIndexPtr();
  std::fill(starts, starts + n + 1, 0);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    ++starts[entries[i].column + 1];
    matrix.innerIndexPtr()[i] = entries[i].row;
    matrix.valuePtr()[i] = entries[i].value;
  }
  std::partial_sum(starts, starts + n + 1, starts);
  return matrix;
}

SparseMatrix laplacian_of_edges(std::vector<MatrixPair> weights, Index n) {
  std::erase_if(weights, [](const MatrixPair& edge) { return edge.a == edge.b; });
  for (MatrixPair& edge : weights) edge.value = -edge.value;
  // A first round with nothing on the diagonal gives each edge's sum, hence the row sums.
  const SparseMatrix off = symmetric_matrix(weights, Eigen::VectorXd::Zero(n));
  Eigen::VectorXd diagonal(n);
  for (Index j = 0; j < n; ++j) {
    double sum = 0.0;
    for (SparseMatrix::InnerIterator it(off, j); it; ++it) sum -= it.value();
    diagonal[j] = sum;
  }
  return off + symmetric_matrix({}, diagonal);
}

}  // namespace timbre::detail
