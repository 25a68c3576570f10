#include "timbre/analysis/spectrum/detail/pencil.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "timbre/analysis/core/error.h"

namespace timbre::detail {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

void require_same_square(const SparseMatrix& K, const SparseMatrix& M) {
  if (K.rows() == K.cols() && M.rows() == K.rows() && M.cols() == K.cols()) return;
  const auto shape = [](const SparseMatrix& A) {
    return std::to_string(A.rows()) + " x " + std::to_string(A.cols());
  };
  throw Error(ErrorKind::bad_request, "", "pencil",
              "matrices of " + shape(K) + " and " + shape(M) +
                  "; both must be square and of the same size");
}

// Entries of one column from the diagonal down.
SparseMatrix::InnerIterator lower_part(const SparseMatrix& A, Eigen::Index column) {
  SparseMatrix::InnerIterator it(A, column);
  while (it && it.row() < column) ++it;
  return it;
}

void append(Pencil& pencil, int row, double k, double m) {
  pencil.row.push_back(row);
  pencil.k.push_back(k);
  pencil.m.push_back(m);
}

// Merges the two sorted columns; the diagonal comes first, present or not.
void append_column(Pencil& pencil, const SparseMatrix& K, const SparseMatrix& M, int column) {
  auto in_k = lower_part(K, column);
  auto in_m = lower_part(M, column);
  for (int row = column;;) {
    const bool has_k = in_k && in_k.row() == row;
    const bool has_m = in_m && in_m.row() == row;
    append(pencil, row, has_k ? in_k.value() : 0.0, has_m ? in_m.value() : 0.0);
    if (has_k) ++in_k;
    if (has_m) ++in_m;
    if (!in_k && !in_m) break;
    row =
        static_cast<int>(std::min(in_k ? in_k.row() : in_m.row(), in_m ? in_m.row() : in_k.row()));
  }
  pencil.start.push_back(std::ssize(pencil.row));
}

}  // namespace

Pencil make_pencil(const SparseMatrix& K, const SparseMatrix& M) {
  require_same_square(K, M);
  Pencil pencil;
  pencil.size = static_cast<int>(K.rows());
  pencil.start.reserve(static_cast<std::size_t>(pencil.size) + 1);
  const auto most = static_cast<std::size_t>(K.nonZeros() + M.nonZeros() + K.rows());
  pencil.row.reserve(most);
  pencil.k.reserve(most);
  pencil.m.reserve(most);
  pencil.start.push_back(0);
  for (int j = 0; j < pencil.size; ++j) append_column(pencil, K, M, j);
  return pencil;
}

// Two bucket sorts, by row and then by column, so that the rows of each column ascend.
Pencil permuted(const Pencil& pencil, const std::vector<int>& order) {
  const int n = pencil.size;
  std::vector<int> place(order.size());
  for (int i = 0; i < n; ++i) place[order[i]] = i;
  struct Entry {
    int column;
    std::int64_t from;
  };
  std::vector<std::int64_t> row_start(order.size() + 1, 0);
  Pencil out;
  out.size = n;
  out.start.assign(order.size() + 1, 0);
  const auto for_each = [&](auto&& visit) {
    for (int j = 0; j < n; ++j) {
      for (std::int64_t e = pencil.start[j]; e < pencil.start[j + 1]; ++e) {
        const int a = place[j];
        const int b = place[pencil.row[e]];
        visit(std::max(a, b), std::min(a, b), e);
      }
    }
  };
  for_each([&](int row, int column, std::int64_t) {
    ++row_start[row + 1];
    ++out.start[column + 1];
  });
  for (int i = 0; i < n; ++i) {
    row_start[i + 1] += row_start[i];
    out.start[i + 1] += out.start[i];
  }
  const auto entries = static_cast<std::size_t>(pencil.entries());
  std::vector<Entry> by_row(entries);
  std::vector<std::int64_t> next(row_start.begin(), row_start.end() - 1);
  for_each([&](int row, int column, std::int64_t e) { by_row[next[row]++] = {column, e}; });
  out.row.resize(entries);
  out.k.resize(entries);
  out.m.resize(entries);
  next.assign(out.start.begin(), out.start.end() - 1);
  for (int i = 0; i < n; ++i) {
    for (std::int64_t e = row_start[i]; e < row_start[i + 1]; ++e) {
      const std::int64_t to = next[by_row[e].column]++;
      out.row[to] = i;
      out.k[to] = pencil.k[by_row[e].from];
      out.m[to] = pencil.m[by_row[e].from];
    }
  }
  return out;
}

void multiply(const Pencil& pencil, double shift, const double* X, int width, double* Y) {
  const auto p = static_cast<std::int64_t>(width);
  std::fill_n(Y, pencil.size * p, 0.0);
  for (int j = 0; j < pencil.size; ++j) {
    const double* xj = X + j * p;
    double* yj = Y + j * p;
    for (std::int64_t e = pencil.start[j]; e < pencil.start[j + 1]; ++e) {
      const int i = pencil.row[e];
      const double a = pencil.k[e] - shift * pencil.m[e];
      const double* xi = X + i * p;
      double* yi = Y + i * p;
      for (int c = 0; c < width; ++c) yi[c] += a * xj[c];
      if (i == j) continue;
      for (int c = 0; c < width; ++c) yj[c] += a * xi[c];
    }
  }
}

void eigenpair_rests(const Pencil& pencil, const double* values, const double* X, double* R) {
  constexpr int kWidth = kPencilWidth;
  std::fill_n(R, std::int64_t{pencil.size} * kWidth, 0.0);
  std::array<double, kWidth> a{};
  for (int j = 0; j < pencil.size; ++j) {
    const double* xj = X + std::int64_t{j} * kWidth;
    double* rj = R + std::int64_t{j} * kWidth;
    for (std::int64_t e = pencil.start[j]; e < pencil.start[j + 1]; ++e) {
      const int i = pencil.row[e];
      const double k = pencil.k[e];
      const double m = pencil.m[e];
      for (int c = 0; c < kWidth; ++c) a[c] = k - values[c] * m;
      const double* xi = X + std::int64_t{i} * kWidth;
      double* ri = R + std::int64_t{i} * kWidth;
      for (int c = 0; c < kWidth; ++c) ri[c] += a[c] * xj[c];
      if (i == j) continue;
      for (int c = 0; c < kWidth; ++c) rj[c] += a[c] * xi[c];
    }
  }
}

std::vector<double> row_scales(const Pencil& pencil, double shift) {
  std::vector<double> scale(static_cast<std::size_t>(pencil.size), 0.0);
  for (int j = 0; j < pencil.size; ++j) {
    for (std::int64_t e = pencil.start[j]; e < pencil.start[j + 1]; ++e) {
      const double a = std::abs(pencil.k[e] - shift * pencil.m[e]);
      double& other = scale[pencil.row[e]];
      scale[j] = std::max(scale[j], a);
      other = std::max(other, a);
    }
  }
  return scale;
}

}  // namespace timbre::detail
