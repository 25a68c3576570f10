#pragma once

#include "timbre/analysis/spectrum/detail/block_kernels.h"
#include "timbre/analysis/spectrum/detail/simd.h"

// The kernels as templates over the number of doubles in a vector register. As with those of
// tiles, all is in an unnamed namespace: code of one set must never be linked into another.

// NOLINTBEGIN(bugprone-implicit-widening-of-multiplication-result): a few rows
namespace timbre::detail {
namespace {

template <int Lanes>
struct BlockProducts {
  using Vector = typename Simd<Lanes>::Vector;
  static constexpr int kSums = Lanes == 8 ? 16 : 8;  // that fit the registers

  static Vector& at(double* p) { return *reinterpret_cast<Vector*>(p); }
  static const Vector& at(const double* p) { return *reinterpret_cast<const Vector*>(p); }

  // Rows [0, R) of H, for R columns of V. Fetches are spread evenly: in one burst they wait for
  // each other.
  template <int P, int R>
  static void add_rows(const double* V, const double* Z, int rows, double* H, const double* next) {
    constexpr int N = P / Lanes;
    Vector sum[R][N];
    for (int i = 0; i < R; ++i) {
      for (int v = 0; v < N; ++v) sum[i][v] = at(H + i * P + v * Lanes);
    }
    for (int r = 0; r < rows; ++r, V += P, Z += P, next += R) {
      __builtin_prefetch(next);
      for (int i = 0; i < R; ++i) {
        for (int v = 0; v < N; ++v) sum[i][v] += at(Z + v * Lanes) * V[i];
      }
    }
    for (int i = 0; i < R; ++i) {
      for (int v = 0; v < N; ++v) at(H + i * P + v * Lanes) = sum[i][v];
    }
  }

  template <int P>
  static void add_block(const double* V, const double* Z, int rows, double* H, const double* next) {
    constexpr int R = kSums * Lanes / P < P ? kSums * Lanes / P : P;
    for (int i = 0; i < P; i += R, next += rows * R) {
      add_rows<P, R>(V + i, Z, rows, H + i * P, next);
    }
  }

  // R rows of U.
  template <int P, int R>
  [[gnu::always_inline]] static inline void subtract_rows(const double* V, const double* H,
                                                          double* U) {
    constexpr int N = P / Lanes;
    Vector sum[R][N];
    for (int i = 0; i < R; ++i) {
      for (int v = 0; v < N; ++v) sum[i][v] = at(U + i * P + v * Lanes);
    }
    for (int k = 0; k < P; ++k) {
      for (int v = 0; v < N; ++v) {
        const Vector h = at(H + k * P + v * Lanes);
        for (int i = 0; i < R; ++i) sum[i][v] -= h * V[i * P + k];
      }
    }
    for (int i = 0; i < R; ++i) {
      for (int v = 0; v < N; ++v) at(U + i * P + v * Lanes) = sum[i][v];
    }
  }

  template <int P>
  static void subtract_block(const double* V, const double* H, int rows, double* U,
                             const double* next) {
    constexpr int R = kSums * Lanes / P < 8 ? kSums * Lanes / P : 8;
    int r = 0;
    for (; r + R <= rows; r += R, V += R * P, U += R * P, next += R * P) {
      for (int i = 0; i < R * P; i += 8) __builtin_prefetch(next + i);
      subtract_rows<P, R>(V, H, U);
    }
    for (; r < rows; ++r, V += P, U += P) subtract_rows<P, 1>(V, H, U);
  }

  static void add_products(const double* V, const double* Z, int rows, int width, double* H,
                           const double* next) {
    if (width == 8) return add_block<8>(V, Z, rows, H, next);
    add_block<16>(V, Z, rows, H, next);
  }

  static void subtract_multiples(const double* V, const double* H, int rows, int width, double* U,
                                 const double* next) {
    if (width == 8) return subtract_block<8>(V, H, rows, U, next);
    subtract_block<16>(V, H, rows, U, next);
  }

  static constexpr BlockKernels table() { return {add_products, subtract_multiples}; }
};

}  // namespace
}  // namespace timbre::detail
// NOLINTEND(bugprone-implicit-widening-of-multiplication-result)
