#include "timbre/analysis/spectrum/detail/diagonal_block.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <numeric>
#include <utility>

namespace timbre::detail {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
const double kAlpha = (1.0 + std::sqrt(17.0)) / 8.0;  // bounds the growth of both pivot sizes alike

// The block while it is eliminated, column by column.
class BunchKaufman {
 public:
  BunchKaufman(const TileKernels& kernels, double* A, int width, const double* scale,
               const DiagonalBlock& out)
      : kernels_(kernels), A_(A), ld_(padded(width)), width_(width), scale_(scale), out_(out) {
    std::iota(out.order, out.order + width, 0);
    std::fill_n(out.e, width, 0.0);
  }

  PivotCounts run() {
    for (int k = 0; k < width_;) {
      const auto [row, size] = choose(k);
      swap_rows(k + size - 1, row);
      if (size == 1) {
        eliminate_one(k);
      } else {
        eliminate_two(k);
      }
      k += size;
    }
    return counts_;
  }

 private:
  double& a(int i, int j) { return A_[i + j * ld_]; }
  [[nodiscard]] double scale(int k) const { return scale_[out_.order[k]]; }

  struct Choice {
    int row;   // comes to the pivot's last row
    int size;  // 1 or 2
  };

  Choice choose(int k) {
    const double own = std::abs(a(k, k));
    int row = k;
    double in_column = 0.0;
    for (int i = k + 1; i < width_; ++i) {
      if (std::abs(a(i, k)) > in_column) in_column = std::abs(a(row = i, k));
    }
    if (!(in_column > kEpsilon * scale(k)) || own >= kAlpha * in_column) return {k, 1};
    double in_row = 0.0;
    for (int j = k; j < row; ++j) in_row = std::max(in_row, std::abs(a(row, j)));
    for (int i = row + 1; i < width_; ++i) in_row = std::max(in_row, std::abs(a(i, row)));
    if (own * in_row >= kAlpha * in_column * in_column) return {k, 1};
    if (std::abs(a(row, row)) >= kAlpha * in_row) return {row, 1};
    return {row, 2};
  }

  // Rows and columns i < j of the matrix and rows of the factor so far.
  void swap_rows(int i, int j) {
    if (i == j) return;
    std::swap(out_.order[i], out_.order[j]);
    std::swap(a(i, i), a(j, j));
    for (int k = 0; k < i; ++k) std::swap(a(i, k), a(j, k));
    for (int k = i + 1; k < j; ++k) std::swap(a(k, i), a(j, k));
    for (int k = j + 1; k < width_; ++k) std::swap(a(k, i), a(k, j));
  }

  void eliminate_one(int k) {
    double pivot = a(k, k);
    if (!(std::abs(pivot) > kEpsilon * scale(k))) {
      pivot =
          std::copysign(std::max(kEpsilon * scale(k), std::numeric_limits<double>::min()), pivot);
      ++counts_.replaced;
    }
    if (scale(k) > 0.0) counts_.smallest = std::min(counts_.smallest, std::abs(pivot) / scale(k));
    counts_.negative += pivot < 0.0 ? 1 : 0;
    out_.d[k] = 1.0 / pivot;
    kernels_.eliminate_one(A_, width_, k, out_.d[k]);
  }

  // The choice of the pivot sees to it that the determinant is clearly negative.
  void eliminate_two(int k) {
    const double x = a(k, k);
    const double y = a(k + 1, k + 1);
    const double z = a(k + 1, k);
    const double t = (x / z) * (y / z) - 1.0;  // the determinant over z^2
    out_.d[k] = y / z / z / t;
    out_.d[k + 1] = x / z / z / t;
    out_.e[k] = -1.0 / z / t;
    a(k + 1, k) = 0.0;
    ++counts_.two_by_two;
    ++counts_.negative;
    const double least = std::abs(t) * z * z / (std::abs(x) + std::abs(y) + std::abs(z));
    counts_.smallest = std::min(counts_.smallest, least / std::max(scale(k), scale(k + 1)));
    kernels_.eliminate_two(A_, width_, k, out_.d + k, out_.e[k]);
  }

  const TileKernels& kernels_;
  double* A_;
  std::ptrdiff_t ld_;
  int width_;
  const double* scale_;
  DiagonalBlock out_;
  PivotCounts counts_;
};

void copy_to_tiles(const double* X, int width, double* tiles) {
  const std::ptrdiff_t ld = padded(width);
  for (std::ptrdiff_t t = 0; t < ld; t += kTile) {
    for (std::ptrdiff_t k = 0; k < ld; ++k, tiles += kTile) {
      if (k < width) {
        std::memcpy(tiles, X + t + k * ld, kTile * sizeof(double));
      } else {
        std::fill_n(tiles, kTile, 0.0);
      }
    }
  }
}

}  // namespace

void PivotCounts::add(const PivotCounts& other) {
  negative += other.negative;
  two_by_two += other.two_by_two;
  replaced += other.replaced;
  smallest = std::min(smallest, other.smallest);
}

PivotCounts factorize_block(const TileKernels& kernels, double* A, int width, const double* scale,
                            double* work, const DiagonalBlock& out) {
  const PivotCounts counts = BunchKaufman(kernels, A, width, scale, out).run();
  const std::ptrdiff_t ld = padded(width);
  for (int k = 0; k < width; ++k) std::fill_n(A + k * ld, k + 1, 0.0);  // L without its diagonal
  kernels.invert(A, width, work);
  copy_to_tiles(work, width, out.inverse);
  return counts;
}

}  // namespace timbre::detail
