#include "timbre/analysis/spectrum/detail/block_basis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "timbre/analysis/spectrum/detail/row_pieces.h"

namespace timbre::detail {
namespace {

constexpr int kWidest = 16;

// A block's share of a chunk.
using ChunkArray = std::array<double, std::size_t{kRowChunk} * kWidest>;

}  // namespace

BlockFactor factorize_gram(const Square& gram, const Eigen::VectorXd& least) {
  constexpr double kRounding = 1e-14;
  const Square G = 0.5 * (gram + gram.transpose());
  const Eigen::Index width = G.rows();
  BlockFactor factor{Square::Zero(width, width), 1.0};
  Square& R = factor.R;
  std::vector<bool> has_row(static_cast<std::size_t>(width), false);
  for (Eigen::Index j = 0; j < width; ++j) {
    const double nothing = std::max(least[j] * least[j], std::numeric_limits<double>::min());
    double left = 0.0;
    if (G(j, j) > nothing) {
      for (Eigen::Index i = 0; i < j; ++i) {
        if (!has_row[static_cast<std::size_t>(i)]) continue;
        R(i, j) = (G(i, j) - R.col(i).head(i).dot(R.col(j).head(i))) / R(i, i);
      }
      left = G(j, j) - R.col(j).head(j).squaredNorm();
    }
    if (left > kRounding * G(j, j) && left > nothing) {
      has_row[static_cast<std::size_t>(j)] = true;
      R(j, j) = std::sqrt(left);
      factor.smallest_pivot = std::min(factor.smallest_pivot, left / G(j, j));
    } else {
      const bool is_known = left > kRounding * G(j, j) || G(j, j) <= nothing;
      R(j, j) = is_known ? 0.0 : 1.0;
      factor.smallest_pivot = 0.0;
    }
  }
  return factor;
}

BlockBasis::BlockBasis(const BlockMass& mass, int width, InstructionSet instructions, int threads)
    : mass_(mass), width_(width), threads_(threads), kernels_(block_kernels(instructions)) {
  if (!mass.is_diagonal()) mass_times_ = AlignedArray(numbers());
}

std::size_t BlockBasis::numbers() const { return at(mass_.size()) * at(width_); }

double* BlockBasis::next() {
  if (at(used_) == slabs_.size() * kBlocksInSlab) slabs_.emplace_back(kBlocksInSlab * numbers());
  return const_cast<double*>(place(used_));
}

// The numbers that are read after these rows of block j: of the next block, or the next rows.
const double* BlockBasis::after(int j, int first, Rows rows) const {
  if (j + 1 < used_) return block(j + 1) + offset(rows);
  const int end = rows.begin + rows.count;
  return block(first) + offset({end < mass_.size() ? end : rows.begin, 0});
}

// H += V^T Z over some rows; Z holds these rows only.
void BlockBasis::add_products(const double* Z, int first, Rows rows, double* H) const {
  for (int j = first; j < used_; ++j, H += at(width_) * at(width_)) {
    kernels_.add_products(block(j) + offset(rows), Z, rows.count, width_, H, after(j, first, rows));
  }
}

// U -= V H over some rows.
void BlockBasis::subtract_multiples(const double* H, int first, Rows rows, double* U) const {
  for (int j = first; j < used_; ++j, H += at(width_) * at(width_)) {
    kernels_.subtract_multiples(block(j) + offset(rows), H, rows.count, width_, U + offset(rows),
                                after(j, first, rows));
  }
}

// Calls `visit(rows)`; chunks of different pieces on several threads.
template <typename Visit>
void BlockBasis::for_each_chunk(Visit visit) const {
  for_each_piece(mass_.size(), threads_, [&](int, int begin, int end) {
    for (int row = begin; row < end; row += kRowChunk) {
      visit(Rows{row, std::min(kRowChunk, end - row)});
    }
  });
}

// The sum, height x width, of what `add(rows, sum)` adds for each chunk: within pieces, then of
// them.
template <typename Add>
Square BlockBasis::sum(Eigen::Index height, Add add) const {
  std::vector<Square> sums(at(row_pieces(mass_.size())), Square::Zero(height, width_));
  for_each_piece(mass_.size(), threads_, [&](int piece, int begin, int end) {
    for (int row = begin; row < end; row += kRowChunk) {
      add(Rows{row, std::min(kRowChunk, end - row)}, sums[at(piece)].data());
    }
  });
  for (std::size_t i = 1; i < sums.size(); ++i) sums[0] += sums[i];
  return std::move(sums[0]);
}

// `change(rows)` changes rows of U, and `add(rows, M U of these rows, sum)` adds to the sum: chunk
// by chunk where M is diagonal, and otherwise with a product between.
template <typename Change, typename Add>
Square BlockBasis::change_and_sum(const double* U, Eigen::Index height, Change change, Add add) {
  if (mass_.is_diagonal()) {
    return sum(height, [&](Rows rows, double* result) {
      alignas(64) ChunkArray Z;
      change(rows);
      mass_.multiply_rows(U, rows.begin, rows.count, width_, Z.data());
      add(rows, Z.data(), result);
    });
  }
  for_each_chunk(change);
  mass_.multiply(U, width_, mass_times_.data());
  return sum(height, [&](Rows rows, double* result) {
    add(rows, mass_times_.data() + offset(rows), result);
  });
}

void BlockBasis::copy(const double* from, double* to) const {
  for_each_chunk([&](Rows rows) {
    std::copy_n(from + offset(rows), at(rows.count) * at(width_), to + offset(rows));
  });
}

Square BlockBasis::subtract_last_but_one(const Square& C, const double* Z, double* U) const {
  const double* const V = used_ > 1 ? block(used_ - 2) : nullptr;
  return sum(width_, [&](Rows rows, double* A) {
    const std::size_t here = offset(rows);
    if (V != nullptr) {
      kernels_.subtract_multiples(V + here, C.data(), rows.count, width_, U + here, Z + here);
    }
    kernels_.add_products(Z + here, U + here, rows.count, width_, A, Z + here);
  });
}

Square BlockBasis::subtract_last(const Square& A, double* U, int first) {
  return change_and_sum(
      U, Eigen::Index{used_ - first} * width_,
      [&](Rows rows) {
        const double* const next = block(first) + offset(rows);
        kernels_.subtract_multiples(block(used_ - 1) + offset(rows), A.data(), rows.count, width_,
                                    U + offset(rows), next);
      },
      [&](Rows rows, const double* Z, double* H) { add_products(Z, first, rows, H); });
}

Square BlockBasis::products(const double* U, int first) {
  return change_and_sum(
      U, Eigen::Index{used_ - first} * width_, [](Rows) {},
      [&](Rows rows, const double* Z, double* H) { add_products(Z, first, rows, H); });
}

Square BlockBasis::subtract(const Square& H, double* U, int first) {
  return change_and_sum(
      U, width_, [&](Rows rows) { subtract_multiples(H.data(), first, rows, U); },
      [&](Rows rows, const double* Z, double* G) {
        const double* const here = U + offset(rows);
        kernels_.add_products(here, Z, rows.count, width_, G, here);
      });
}

BlockFactor BlockBasis::orthonormalize(const Square& G, const Eigen::VectorXd& least, double* U,
                                       double* Z) const {
  BlockFactor factor = factorize_gram(G, least);
  Square divisor = factor.R;
  Square identity = Square::Identity(width_, width_);
  for (int c = 0; c < width_; ++c) {
    if (divisor(c, c) != 0.0) continue;
    divisor(c, c) = 1.0;
    identity(c, c) = 0.0;
  }
  const Square negative = -divisor.triangularView<Eigen::Upper>().solve(identity);
  for_each_chunk([&](Rows rows) {
    alignas(64) ChunkArray result;
    const std::size_t count = at(rows.count) * at(width_);
    double* const here = U + offset(rows);
    std::fill_n(result.begin(), count, 0.0);
    kernels_.subtract_multiples(here, negative.data(), rows.count, width_, result.data(),
                                here + count);
    std::copy_n(result.begin(), count, here);
    if (mass_.is_diagonal()) {
      mass_.multiply_rows(U, rows.begin, rows.count, width_, Z + offset(rows));
    }
  });
  if (!mass_.is_diagonal()) mass_.multiply(U, width_, Z);
  return factor;
}

}  // namespace timbre::detail
