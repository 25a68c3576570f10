#pragma once

#include "timbre/analysis/spectrum/detail/simd.h"
#include "timbre/analysis/spectrum/detail/tile_kernels.h"

// The kernels as templates over the number of doubles in a vector register. Only the files that
// are compiled for an instruction set include this. All is in an unnamed namespace, and nothing
// inline of the standard library is used: code of one set must never be linked into another.

// NOLINTBEGIN(bugprone-implicit-widening-of-multiplication-result): a panel is small
namespace timbre::detail {
namespace {

template <int Lanes>
struct Kernels {
  using Vector = typename Simd<Lanes>::Vector;
  static constexpr int kVectors = kTile / Lanes;              // in a column of a tile
  static constexpr int kSums = Lanes == 8 ? 16 : 8;           // that fit the registers
  static constexpr int kColumns = Lanes;                      // of a product found at once
  static constexpr int kSlice = Lanes == 8 ? 32 : 4 * Lanes;  // right-hand sides done at once

  static constexpr int kAhead = 512;  // doubles, that are asked for before they are read

  static Vector& at(double* p) { return *reinterpret_cast<Vector*>(p); }
  static const Vector& at(const double* p) { return *reinterpret_cast<const Vector*>(p); }

  static constexpr int min(int a, int b) { return a < b ? a : b; }

  // Columns [first, first + kColumns) of A B^T for one tile of each.
  template <typename Finish>
  [[gnu::always_inline]] static inline void product(const double* A, const double* B, int depth,
                                                    const Finish& finish) {
    for (int first = 0; first < kTile; first += kColumns) {
      Vector sum[kColumns][kVectors] = {};
      const double* b = B + first;
      for (int k = 0; k < depth; ++k) {
        for (int c = 0; c < kColumns; ++c) {
          for (int v = 0; v < kVectors; ++v) sum[c][v] += at(A + kTile * k + Lanes * v) * b[c];
        }
        b += kTile;
      }
      for (int c = 0; c < kColumns; ++c) finish(first + c, sum[c]);
    }
  }

  static void subtract_products(const double* A, int count, int stride, const double* B, int depth,
                                double* C, std::int64_t ld) {
    for (int t = 0; t < count; ++t, A += stride, C += kTile) {
      product(
          A, B, depth, [&](int c, const Vector* sum) __attribute__((always_inline)) {
            for (int v = 0; v < kVectors; ++v) at(C + c * ld + Lanes * v) -= sum[v];
          });
    }
  }

  static void multiply_by_transpose(const double* A, int count, const double* X, int width,
                                    double* B) {
    const int stride = kTile * padded(width);
    for (int t = 0; t < count; ++t, A += stride, B += stride) {
      for (int j = 0; j < width; j += kTile) {
        double* out = B + kTile * j;
        product(
            A, X + static_cast<std::int64_t>(j / kTile) * stride,
            min(width, j + kTile), [&](int c, const Vector* sum) __attribute__((always_inline)) {
              for (int v = 0; v < kVectors; ++v) at(out + kTile * c + Lanes * v) = sum[v];
            });
      }
    }
  }

  // y -= factor x from row `from` on, begun a little early: what is above is of no use.
  static void subtract(const double* x, double factor, int from, int end, double* y) {
    for (int i = from / Lanes * Lanes; i < end; i += Lanes) at(y + i) -= at(x + i) * factor;
  }

  static void eliminate_one(double* A, int width, int k, double inverse_pivot) {
    const int ld = padded(width);
    double* a = A + static_cast<std::int64_t>(k) * ld;
    for (int j = k + 1; j < width; ++j) subtract(a, a[j] * inverse_pivot, j, width, A + j * ld);
    for (int i = k + 1; i < width; ++i) a[i] *= inverse_pivot;
  }

  static void eliminate_two(double* A, int width, int k, const double* d, double e) {
    const int ld = padded(width);
    double* a = A + static_cast<std::int64_t>(k) * ld;
    double* b = a + ld;
    for (int j = k + 2; j < width; ++j) {
      subtract(a, a[j] * d[0] + b[j] * e, j, width, A + j * ld);
      subtract(b, a[j] * e + b[j] * d[1], j, width, A + j * ld);
    }
    for (int i = k + 2; i < width; ++i) {
      const double x = a[i];
      const double y = b[i];
      a[i] = x * d[0] + y * e;
      b[i] = x * e + y * d[1];
    }
  }

  static void invert(const double* L, int width, double* X) {
    const int ld = padded(width);
    for (int j = 0; j < width; ++j) {
      double* x = X + static_cast<std::int64_t>(j) * ld;
      for (int i = 0; i < ld; ++i) x[i] = 0.0;
      x[j] = 1.0;
      for (int k = j; k < width; ++k) subtract(L + k * ld, x[k], k + 1, width, x);
    }
  }

  // Where rows of right-hand sides lie: without a gap, or listed.
  struct Places {
    double* X;
    int chunk;
    const int* rows;  // nullptr: from X on
    [[gnu::always_inline]] double* operator()(int i) const {
      return X + static_cast<std::int64_t>(rows == nullptr ? i : rows[i]) * chunk;
    }
  };

  // Rows [first, first + R) of a compact tile times x; stored, or subtracted from what is there.
  template <bool Subtract, int N, int R>
  [[gnu::always_inline]] static inline void rows_times(const double* tile, int height, int depth,
                                                       const double* x, const Places& y, int row) {
    Vector sum[R][N] = {};
    for (int k = 0; k < depth; ++k) {
      for (int r = 0; r < R; ++r) {
        for (int v = 0; v < N; ++v) sum[r][v] += at(x + Lanes * v) * tile[r];
      }
      tile += height;
      x += y.chunk;
    }
    for (int r = 0; r < R; ++r) {
      double* out = y(row + r);
      for (int v = 0; v < N; ++v) {
        if constexpr (Subtract) {
          at(out + Lanes * v) -= sum[r][v];
        } else {
          at(out + Lanes * v) = sum[r][v];
        }
      }
    }
  }

  // x -= (or +=) transposed rows of a compact tile times y.
  template <bool Subtract, int N, int R>
  [[gnu::always_inline]] static inline void transposed_times(const double* tile, int height,
                                                             int depth, double* x, const Places& y,
                                                             int row) {
    Vector in[R][N];
    for (int r = 0; r < R; ++r) {
      const double* from = y(row + r);
      for (int v = 0; v < N; ++v) in[r][v] = at(from + Lanes * v);
    }
    for (int k = 0; k < depth; ++k) {
      for (int v = 0; v < N; ++v) {
        Vector out = at(x + Lanes * v);
        for (int r = 0; r < R; ++r) {
          if constexpr (Subtract) {
            out -= in[r][v] * tile[r];
          } else {
            out += in[r][v] * tile[r];
          }
        }
        at(x + Lanes * v) = out;
      }
      tile += height;
      x += y.chunk;
    }
  }

  // A compact tile in groups of R rows, then of R / 2, ...
  template <bool Forward, bool Subtract, int N, int R>
  [[gnu::always_inline]] static inline void groups(const double* tile, int height, int done,
                                                   int depth, double* x, const Places& y, int row) {
    for (; done + R <= height; done += R) {
      if constexpr (Forward) {
        rows_times<Subtract, N, R>(tile + done, height, depth, x, y, row + done);
      } else {
        transposed_times<Subtract, N, R>(tile + done, height, depth, x, y, row + done);
      }
    }
    if constexpr (R > 1) {
      if (done < height) groups<Forward, Subtract, N, R / 2>(tile, height, done, depth, x, y, row);
    }
  }

  static constexpr int rows_at_once(int n) { return kSums / n < kTile ? kSums / n : kTile; }

  template <bool Subtract, int N>
  static void tiles_times(const double* tile, int rows, int width, bool triangle, double* x,
                          const Places& y) {
    for (int row = 0; row < rows; row += kTile) {
      const int height = min(kTile, rows - row);
      const int depth = triangle ? row + height : width;
      groups<true, Subtract, N, rows_at_once(N)>(tile, height, 0, depth, x, y, row);
      tile += height * depth;
    }
  }

  // From the last tile to the first: the way back through the factor is one stream too, but one
  // that processors do not foresee.
  template <bool Subtract, int N>
  static void transposed_tiles_times(const double* end, int rows, int width, bool triangle,
                                     double* x, const Places& y) {
    for (int row = (rows - 1) / kTile * kTile; row >= 0 && rows > 0; row -= kTile) {
      const int height = min(kTile, rows - row);
      const int depth = triangle ? row + height : width;
      end -= height * depth;
      for (int i = 0; i < height * depth; i += kTile) __builtin_prefetch(end + i - kAhead);
      groups<false, Subtract, N, rows_at_once(N)>(end, height, 0, depth, x, y, row);
    }
  }

  // For some of the right-hand sides.
  template <int N>
  static void forward_slice(const Panel& p, double* X, int chunk) {
    double* own = X + static_cast<std::int64_t>(p.column) * chunk;
    alignas(64) double permuted[kPanelWidth * kMaxChunk];
    for (int k = 0; k < p.width; ++k) {
      for (int v = 0; v < N; ++v) {
        at(permuted + k * chunk + Lanes * v) = at(own + p.order[k] * chunk + Lanes * v);
      }
    }
    tiles_times<false, N>(p.inverse, p.width, p.width, true, permuted, {own, chunk, nullptr});
    double* next = own + static_cast<std::int64_t>(p.width) * chunk;
    tiles_times<true, N>(p.below, p.rest, p.width, false, own, {next, chunk, nullptr});
    tiles_times<true, N>(p.below + p.rest * p.width, p.listed, p.width, false, own,
                         {X, chunk, p.rows});
  }

  template <int N>
  [[gnu::always_inline]] static inline void divide_by_pivots(const Panel& p, const double* own,
                                                             int chunk, double* out) {
    for (int k = 0; k < p.width; ++k) {
      for (int v = 0; v < N; ++v) {
        at(out + k * chunk + Lanes * v) = at(own + k * chunk + Lanes * v) * p.d[k];
      }
    }
    for (int k = 0; k + 1 < p.width; ++k) {
      if (p.e[k] == 0.0) continue;
      for (int v = 0; v < N; ++v) {
        const int here = k * chunk + Lanes * v;
        at(out + here) += at(own + here + chunk) * p.e[k];
        at(out + here + chunk) += at(own + here) * p.e[k];
      }
    }
  }

  template <int N>
  static void backward_slice(const Panel& p, double* X, int chunk) {
    double* own = X + static_cast<std::int64_t>(p.column) * chunk;
    alignas(64) double divided[kPanelWidth * kMaxChunk];
    alignas(64) double solved[kPanelWidth * kMaxChunk];
    divide_by_pivots<N>(p, own, chunk, divided);
    double* next = own + static_cast<std::int64_t>(p.width) * chunk;
    const double* listed = p.below + p.rest * p.width;
    transposed_tiles_times<true, N>(listed + p.listed * p.width, p.listed, p.width, false, divided,
                                    {X, chunk, p.rows});
    transposed_tiles_times<true, N>(listed, p.rest, p.width, false, divided,
                                    {next, chunk, nullptr});
    for (int k = 0; k < p.width; ++k) {
      for (int v = 0; v < N; ++v) at(solved + k * chunk + Lanes * v) = Vector{};
    }
    transposed_tiles_times<false, N>(p.below, p.width, p.width, true, solved,
                                     {divided, chunk, nullptr});
    for (int k = 0; k < p.width; ++k) {
      for (int v = 0; v < N; ++v) {
        at(own + p.order[k] * chunk + Lanes * v) = at(solved + k * chunk + Lanes * v);
      }
    }
  }

  static constexpr int kLeast = Lanes < 4 ? 4 : Lanes;

  template <int Columns>
  static void forward_in_slices(const Panel& panel, double* X, int stride, int columns) {
    for (int c = 0; c < columns; c += Columns) {
      forward_slice<Columns / Lanes>(panel, X + c, stride);
    }
  }

  template <int Columns>
  static void backward_in_slices(const Panel& panel, double* X, int stride, int columns) {
    for (int c = 0; c < columns; c += Columns) {
      backward_slice<Columns / Lanes>(panel, X + c, stride);
    }
  }

  static void forward(const Panel& panel, double* X, int stride, int columns) {
    if (columns == kLeast) return forward_in_slices<kLeast>(panel, X, stride, columns);
    if (columns == 8) return forward_in_slices<8>(panel, X, stride, columns);
    if (columns == 16) return forward_in_slices<min(16, kSlice)>(panel, X, stride, columns);
    forward_in_slices<kSlice>(panel, X, stride, columns);
  }

  static void backward(const Panel& panel, double* X, int stride, int columns) {
    if (columns == kLeast) return backward_in_slices<kLeast>(panel, X, stride, columns);
    if (columns == 8) return backward_in_slices<8>(panel, X, stride, columns);
    if (columns == 16) return backward_in_slices<min(16, kSlice)>(panel, X, stride, columns);
    backward_in_slices<kSlice>(panel, X, stride, columns);
  }

  static constexpr TileKernels table() {
    return {subtract_products,
            multiply_by_transpose,
            eliminate_one,
            eliminate_two,
            invert,
            forward,
            backward,
            kLeast};
  }
};

}  // namespace
}  // namespace timbre::detail
// NOLINTEND(bugprone-implicit-widening-of-multiplication-result)
