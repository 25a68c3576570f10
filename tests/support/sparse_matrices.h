#pragma once

#include <Eigen/SparseCore>
#include <cmath>
#include <random>
#include <string>
#include <vector>

// Symmetric sparse matrices of many patterns, by their lower triangles.

namespace timbre {

using SparseMatrix = Eigen::SparseMatrix<double>;

struct NamedMatrix {
  std::string name;
  SparseMatrix matrix;
};

inline SparseMatrix from_lower(int n, const std::vector<Eigen::Triplet<double>>& entries) {
  SparseMatrix K(n, n);
  K.setFromTriplets(entries.begin(), entries.end(), [](double, double last) { return last; });
  return K;
}

inline SparseMatrix identity(Eigen::Index n) {
  SparseMatrix M(n, n);
  M.setIdentity();
  return M;
}

// Values in [-1, 1] where `wanted(i, j)`, i >= j, and on the diagonal.
template <typename Wanted>
SparseMatrix random_where(int n, unsigned seed, const Wanted& wanted) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < n; ++j) {
    for (int i = j; i < n; ++i) {
      if (i == j || wanted(i, j)) entries.emplace_back(i, j, uniform(random));
    }
  }
  return from_lower(n, entries);
}

// About `degree` entries in each row.
inline SparseMatrix random_sparse(int n, double degree, unsigned seed) {
  std::mt19937 random(seed + 1000);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  return random_where(n, seed, [&](int, int) { return uniform(random) < degree / n; });
}

// [D B^T; B 0] with diagonal D > 0.
inline SparseMatrix saddle_point(int n, int constraints, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.5, 1.5);
  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < n; ++j) entries.emplace_back(j, j, uniform(random));
  for (int i = 0; i < constraints; ++i) {
    for (int k = 0; k < 4; ++k) {
      entries.emplace_back(n + i, static_cast<int>(random() % static_cast<unsigned>(n)),
                           uniform(random));
    }
  }
  return from_lower(n + constraints, entries);
}

// The same pattern with a diagonal that dominates each row.
inline SparseMatrix made_definite(SparseMatrix K) {
  std::vector<double> sums(static_cast<std::size_t>(K.rows()), 0.1);
  for (int j = 0; j < K.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator it(K, j); it; ++it) {
      if (it.row() <= j) continue;
      sums[static_cast<std::size_t>(j)] += std::abs(it.value());
      sums[static_cast<std::size_t>(it.row())] += std::abs(it.value());
    }
  }
  for (int j = 0; j < K.rows(); ++j) K.coeffRef(j, j) = sums[static_cast<std::size_t>(j)];
  K.makeCompressed();
  return K;
}

inline std::vector<NamedMatrix> matrices_of_many_patterns() {
  const auto never = [](int, int) { return false; };
  const auto always = [](int, int) { return true; };
  return {
      {"empty", SparseMatrix(0, 0)},
      {"one", random_where(1, 1, never)},
      {"two", random_where(2, 2, always)},
      {"diagonal", random_where(50, 3, never)},
      {"tridiagonal", random_where(100, 4, [](int i, int j) { return i - j == 1; })},
      {"long_tridiagonal", random_where(500, 4, [](int i, int j) { return i - j == 1; })},
      {"band", random_where(120, 5, [](int i, int j) { return i - j < 12; })},
      {"arrow_down", random_where(90, 6, [](int i, int) { return i == 89; })},
      {"arrow_up", random_where(90, 7, [](int, int j) { return j == 0; })},
      {"dense_7", random_where(7, 8, always)},
      {"dense_64", random_where(64, 9, always)},
      {"dense_65", random_where(65, 10, always)},
      {"dense_200", random_where(200, 11, always)},
      {"blocks", random_where(130, 12, [](int i, int j) { return i / 13 == j / 13; })},
      {"two_components",
       random_where(140, 13, [](int i, int j) { return i % 2 == j % 2 && (i * j) % 7 == 1; })},
      {"grid",
       random_where(400, 14,
                    [](int i, int j) { return i - j == 20 || (i - j == 1 && i % 20 != 0); })},
      {"sparse_random", random_sparse(300, 3.0, 15)},
      {"random", random_sparse(150, 12.0, 16)},
      {"wide_arrow", random_where(300, 17, [](int i, int j) { return i >= 290 || i - j == 3; })},
  };
}

}  // namespace timbre
