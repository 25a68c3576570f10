#include "timbre/analysis/spectrum/detail/block_mass.h"

#include <cstdint>

#include "timbre/analysis/spectrum/detail/row_pieces.h"

namespace timbre::detail {

BlockMass::BlockMass(const Pencil& pencil, int threads)
    : pencil_(&pencil), threads_(threads), diagonal_(static_cast<std::size_t>(pencil.size)) {
  for (int j = 0; j < pencil.size; ++j) {
    const auto column = static_cast<std::size_t>(j);
    const std::int64_t begin = pencil.start[column];
    diagonal_[column] = pencil.m[static_cast<std::size_t>(begin)];
    for (std::int64_t k = begin + 1; k < pencil.start[column + 1]; ++k) {
      if (pencil.m[static_cast<std::size_t>(k)] != 0.0) is_diagonal_ = false;
    }
  }
}

void BlockMass::multiply_rows(const double* U, int begin, int rows, int width, double* Z) const {
  const auto count = static_cast<std::size_t>(width);
  const double* row = U + static_cast<std::size_t>(begin) * count;
  for (int i = 0; i < rows; ++i, row += count, Z += count) {
    const double m = diagonal(begin + i);
    for (std::size_t c = 0; c < count; ++c) Z[c] = m * row[c];
  }
}

void BlockMass::multiply(const double* U, int width, double* Z) const {
  for_each_piece(size(), threads_, [&](int, int begin, int end) {
    double* const rows = Z + static_cast<std::size_t>(begin) * static_cast<std::size_t>(width);
    multiply_rows(U, begin, end - begin, width, rows);
  });
  if (is_diagonal_) return;
  for (int j = 0; j < size(); ++j) {
    const auto column = static_cast<std::size_t>(j);
    const double* const own = U + column * static_cast<std::size_t>(width);
    double* const out = Z + column * static_cast<std::size_t>(width);
    for (std::int64_t k = pencil_->start[column] + 1; k < pencil_->start[column + 1]; ++k) {
      const double m = pencil_->m[static_cast<std::size_t>(k)];
      const auto row = static_cast<std::size_t>(pencil_->row[static_cast<std::size_t>(k)]) *
                       static_cast<std::size_t>(width);
      for (int c = 0; c < width; ++c) {
        out[c] += m * U[row + static_cast<std::size_t>(c)];
        Z[row + static_cast<std::size_t>(c)] += m * own[c];
      }
    }
  }
}

}  // namespace timbre::detail
