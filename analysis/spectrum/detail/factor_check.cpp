#include "timbre/analysis/spectrum/detail/factor_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include "timbre/analysis/spectrum/detail/aligned_array.h"

namespace timbre::detail {
namespace {

constexpr int kVectors = 8;

using Norms = std::array<double, kVectors>;

template <typename Value>
Norms column_norms(int n, const Value& value) {
  Norms sums{};
  for (int i = 0; i < n; ++i) {
    for (int c = 0; c < kVectors; ++c) {
      const double x = value(i, c);
      sums[c] += x * x;
    }
  }
  for (double& sum : sums) sum = std::sqrt(sum);
  return sums;
}

// S of S A S, and the largest row sum of |S A S|.
struct Scaling {
  std::vector<double> factor;
  double norm = 0.0;
};

Scaling scaling(const Pencil& pencil, double shift) {
  Scaling s{row_scales(pencil, shift)};
  for (double& x : s.factor) x = x > 0.0 ? 1.0 / std::sqrt(x) : 1.0;
  std::vector<double> sums(s.factor.size(), 0.0);
  for (int j = 0; j < pencil.size; ++j) {
    for (std::int64_t e = pencil.start[j]; e < pencil.start[j + 1]; ++e) {
      const int i = pencil.row[e];
      const double a = std::abs(pencil.k[e] - shift * pencil.m[e]) * s.factor[i] * s.factor[j];
      sums[i] += a;
      if (i != j) sums[j] += a;
    }
  }
  for (const double sum : sums) s.norm = std::max(s.norm, sum);
  return s;
}

}  // namespace

FactorCheck check_factor(const Pencil& pencil, double shift, const BlockSolve& solve) {
  FactorCheck check;
  const int n = pencil.size;
  if (n == 0) return check;
  const Scaling scale = scaling(pencil, shift);
  const auto values = static_cast<std::size_t>(n) * kVectors;
  AlignedArray b(values);
  AlignedArray x(values);
  AlignedArray product(values);
  const auto place = [](int i, int c) { return static_cast<std::ptrdiff_t>(i) * kVectors + c; };
  std::mt19937_64 random(1);
  for (int i = 0; i < n; ++i) {
    for (int c = 0; c < kVectors; ++c) {
      const double uniform = static_cast<double>(random() >> 11U) * 0x1p-53 - 0.5;
      b.data()[place(i, c)] = uniform / scale.factor[i];
    }
  }
  for (int step = 0; step < 2; ++step) {
    std::copy_n(b.data(), values, x.data());
    solve(x.data(), kVectors);
    multiply(pencil, shift, x.data(), kVectors, product.data());
    const Norms error = column_norms(n, [&](int i, int c) {
      return scale.factor[i] * (product.data()[place(i, c)] - b.data()[place(i, c)]);
    });
    const Norms of_b =
        column_norms(n, [&](int i, int c) { return scale.factor[i] * b.data()[place(i, c)]; });
    const Norms of_x =
        column_norms(n, [&](int i, int c) { return x.data()[place(i, c)] / scale.factor[i]; });
    for (int c = 0; c < kVectors; ++c) {
      const double backward = error[c] / (scale.norm * of_x[c] + of_b[c]);
      // Written so that what is not a number counts as infinitely wrong.
      constexpr double kInfinity = std::numeric_limits<double>::infinity();
      check.backward_error = std::max(check.backward_error, backward >= 0.0 ? backward : kInfinity);
      const double residual = error[c] / of_b[c];
      check.residual = std::max(check.residual, residual >= 0.0 ? residual : kInfinity);
    }
    for (int i = 0; i < n; ++i) {
      const double s2 = scale.factor[i] * scale.factor[i];
      for (int c = 0; c < kVectors; ++c) {
        b.data()[place(i, c)] = x.data()[place(i, c)] / (s2 * of_x[c]);
      }
    }
  }
  return check;
}

}  // namespace timbre::detail
