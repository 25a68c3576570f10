#include "timbre/analysis/spectrum/detail/block_basis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "timbre/analysis/spectrum/detail/row_pieces.h"

namespace timbre::detail {

// Rows of a block that stay in cache while all blocks pass by.
constexpr int kChunk = kRowChunk;

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

void BlockMass::multiply(const double* U, int width, double* Z) const {
  const int n = size();
  for_each_piece(n, threads_, [&](int, int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const double m = diagonal(i);
      const std::size_t row = static_cast<std::size_t>(i) * static_cast<std::size_t>(width);
      for (int c = 0; c < width; ++c)
        Z[row + static_cast<std::size_t>(c)] = m * U[row + static_cast<std::size_t>(c)];
    }
  });
  if (is_diagonal_) return;
  for (int j = 0; j < n; ++j) {
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

BlockBasis::BlockBasis(int size, int width, InstructionSet instructions, int threads)
    : size_(size), width_(width), threads_(threads), kernels_(block_kernels(instructions)) {}

std::size_t BlockBasis::numbers() const { return at(size_) * at(width_); }

double* BlockBasis::next() {
  if (at(used_) == slabs_.size() * kBlocksInSlab) slabs_.emplace_back(kBlocksInSlab * numbers());
  return const_cast<double*>(place(used_));
}

// Calls `visit(first number, rows)`; chunks of different pieces on several threads.
template <typename Visit>
void BlockBasis::for_each_chunk(Visit visit) const {
  for_each_piece(size_, threads_, [&](int, int begin, int end) {
    for (int row = begin; row < end; row += kChunk) {
      visit(at(row) * at(width_), std::min(kChunk, end - row));
    }
  });
}

// The sum of what `add(first number, rows, sum)` adds for each chunk: within pieces, then of them.
template <typename Add>
Square BlockBasis::sum(Eigen::Index rows, Add add) const {
  std::vector<Square> sums(at(row_pieces(size_)), Square::Zero(rows, width_));
  for_each_piece(size_, threads_, [&](int piece, int begin, int end) {
    for (int row = begin; row < end; row += kChunk) {
      add(at(row) * at(width_), std::min(kChunk, end - row), sums[at(piece)].data());
    }
  });
  for (std::size_t i = 1; i < sums.size(); ++i) sums[0] += sums[i];
  return std::move(sums[0]);
}

Square BlockBasis::products(const double* Z, int first) const {
  const std::size_t square = at(width_) * at(width_);
  return sum(Eigen::Index{used_ - first} * width_, [&](std::size_t begin, int rows, double* H) {
    for (int j = first; j < used_; ++j) {
      kernels_.add_products(block(j) + begin, Z + begin, rows, width_, H + at(j - first) * square);
    }
  });
}

void BlockBasis::subtract(const Square& H, double* U, int first) const {
  const int square = width_ * width_;
  for_each_chunk([&](std::size_t begin, int rows) {
    for (int j = first; j < used_; ++j) {
      kernels_.subtract_multiples(block(j) + begin, H.data() + at(j - first) * at(square), rows,
                                  width_, U + begin);
    }
  });
}

void BlockBasis::copy(const double* from, double* to) const {
  for_each_piece(size_, threads_, [&](int, int begin, int end) {
    std::copy_n(from + at(begin) * at(width_), at(end - begin) * at(width_),
                to + at(begin) * at(width_));
  });
}

Square BlockBasis::gram(const double* A, const double* B) const {
  return sum(width_, [&](std::size_t begin, int rows, double* G) {
    kernels_.add_products(A + begin, B + begin, rows, width_, G);
  });
}

void BlockBasis::subtract(const double* V, const Square& H, double* U) const {
  for_each_chunk([&](std::size_t begin, int rows) {
    kernels_.subtract_multiples(V + begin, H.data(), rows, width_, U + begin);
  });
}

void BlockBasis::multiply_right(const Square& T, double* U, double* Z) const {
  const Square negative = -T;
  for_each_chunk([&](std::size_t begin, int rows) {
    alignas(64) std::array<double, std::size_t{kChunk} * 16> result;
    for (double* const block : {U, Z}) {
      const auto count = at(rows) * at(width_);
      std::fill_n(result.begin(), count, 0.0);
      kernels_.subtract_multiples(block + begin, negative.data(), rows, width_, result.data());
      std::copy_n(result.begin(), count, block + begin);
    }
  });
}

BlockFactor BlockBasis::orthonormalise(double* U, double* Z) const {
  const Square gram_matrix = gram(U, Z);
  const Square G = 0.5 * (gram_matrix + gram_matrix.transpose());
  BlockFactor factor{Square::Zero(width_, width_), 1.0};
  Square& R = factor.R;
  for (int j = 0; j < width_; ++j) {
    for (int i = 0; i < j; ++i) {
      const double below = R.col(i).head(i).dot(R.col(j).head(i));
      R(i, j) = (G(i, j) - below) / R(i, i);
    }
    const double left = G(j, j) - R.col(j).head(j).squaredNorm();
    factor.smallest_pivot = std::min(factor.smallest_pivot, left / G(j, j));
    R(j, j) = std::sqrt(std::max(left, 1e-30 * std::abs(G(j, j)) + 1e-300));
  }
  const Square inverse = R.triangularView<Eigen::Upper>().solve(Square::Identity(width_, width_));
  multiply_right(inverse, U, Z);
  return factor;
}

}  // namespace timbre::detail
