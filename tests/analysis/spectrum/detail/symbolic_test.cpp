#include "timbre/analysis/spectrum/detail/symbolic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/tests/support/sparse_matrices.h"

namespace timbre::detail {
namespace {

Pencil pencil_of(const SparseMatrix& K) { return make_pencil(K, SparseMatrix(K.rows(), K.cols())); }

std::vector<int> shuffled(int n) {
  std::vector<int> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  std::mt19937 random(5);
  for (int i = n - 1; i > 0; --i)
    std::swap(order[i], order[random() % static_cast<unsigned>(i + 1)]);
  return order;
}

using Pattern = std::vector<std::vector<bool>>;

// The pattern of L by its definition: eliminating a column joins all rows below it.
Pattern filled(const Pencil& pencil) {
  const auto n = static_cast<std::size_t>(pencil.size);
  Pattern L(n, std::vector<bool>(n, false));
  for (std::size_t j = 0; j < n; ++j) {
    for (auto e = pencil.start[j]; e < pencil.start[j + 1]; ++e) L[pencil.row[e]][j] = true;
  }
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t j = k + 1; j < n; ++j) {
      for (std::size_t i = j; L[j][k] && i < n; ++i) {
        if (L[i][k]) L[i][j] = true;
      }
    }
  }
  return L;
}

class SymbolicPattern : public testing::TestWithParam<NamedMatrix> {};

TEST_P(SymbolicPattern, TreeAndCountsAreThoseOfTheFilledMatrix) {
  const Pencil given = pencil_of(GetParam().matrix);
  const Pencil mixed = permuted(given, shuffled(given.size));
  const Pencil pencil = permuted(mixed, postorder(elimination_tree(mixed)));
  const std::vector<int> parent = elimination_tree(pencil);
  const std::vector<int> count = column_counts(pencil, parent);
  const Pattern L = filled(pencil);
  for (int j = 0; j < pencil.size; ++j) {
    int first = -1;
    int entries = 0;
    for (int i = pencil.size - 1; i >= j; --i) {
      if (!L[i][j]) continue;
      ++entries;
      if (i > j) first = i;
    }
    EXPECT_EQ(parent[j], first) << j;
    EXPECT_EQ(count[j], entries) << j;
  }
}

TEST_P(SymbolicPattern, SupernodesHoldThePatternOfTheFactor) {
  const Pencil pencil = pencil_of(GetParam().matrix);
  const SymbolicFactor symbolic = analyse(pencil, shuffled(pencil.size));
  const Pattern L = filled(permuted(pencil, symbolic.order));
  ASSERT_EQ(symbolic.first_column.front(), 0);
  ASSERT_EQ(symbolic.first_column.back(), pencil.size);
  std::int64_t entries = 0;
  for (int s = 0; s < symbolic.supernodes(); ++s) {
    const auto begin = symbolic.rows.begin() + symbolic.first_row[s];
    const auto end = symbolic.rows.begin() + symbolic.first_row[s + 1];
    EXPECT_TRUE(std::is_sorted(begin, end));
    for (int j = symbolic.first_column[s]; j < symbolic.first_column[s + 1]; ++j) {
      entries += symbolic.first_column[s + 1] - j + symbolic.rows_below(s);
      for (int i = symbolic.first_column[s + 1]; i < pencil.size; ++i) {
        EXPECT_TRUE(!L[i][j] || std::binary_search(begin, end, i)) << i << ", " << j;
      }
    }
  }
  EXPECT_EQ(symbolic.entries, entries);
}

TEST_P(SymbolicPattern, PlacesLeadToTheSameRowsOfTheParent) {
  const Pencil pencil = pencil_of(GetParam().matrix);
  const SymbolicFactor symbolic = analyse(pencil, shuffled(pencil.size));
  for (int s = 0; s < symbolic.supernodes(); ++s) {
    const int p = symbolic.parent[s];
    EXPECT_EQ(p == -1, symbolic.rows_below(s) == 0);
    for (auto e = symbolic.first_row[s]; e < symbolic.first_row[s + 1]; ++e) {
      const int place = symbolic.place[e];
      const int columns = symbolic.columns(p);
      const int row = place < columns ? symbolic.first_column[p] + place
                                      : symbolic.rows[symbolic.first_row[p] + place - columns];
      EXPECT_EQ(row, symbolic.rows[e]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Patterns, SymbolicPattern, testing::ValuesIn(matrices_of_many_patterns()),
                         [](const auto& test) { return test.param.name; });

TEST(Analyse, FindsNoZerosInADenseMatrix) {
  const SymbolicFactor symbolic =
      analyse(pencil_of(random_where(100, 1, [](int, int) { return true; })), shuffled(100));
  EXPECT_EQ(symbolic.supernodes(), 1);
  EXPECT_EQ(symbolic.entries, 100 * 101 / 2);
  EXPECT_EQ(symbolic.flops, 100.0 * 101.0 * 201.0 / 6.0);
}

TEST(Analyse, RefusesWhatIsNoPermutation) {
  const Pencil pencil = pencil_of(identity(3));
  for (const std::vector<int>& order :
       {std::vector<int>{0, 1}, {0, 1, 1}, {0, 1, 3}, {-1, 1, 2}, {0, 1, 2, 3}}) {
    try {
      (void)analyse(pencil, order);
      FAIL() << "no exception";
    } catch (const Error& error) {
      EXPECT_STREQ(error.what(), "ordering: is no permutation of the 3 unknowns");
    }
  }
}

TEST(MakePencil, UnitesThePatternsAndReadsTheLowerHalf) {
  SparseMatrix K(3, 3);
  K.insert(1, 0) = 5.0;
  K.insert(0, 1) = 7.0;  // not read
  SparseMatrix M(3, 3);
  M.insert(2, 0) = 2.0;
  M.insert(1, 1) = 3.0;
  const Pencil pencil = make_pencil(K, M);
  EXPECT_EQ(pencil.row, (std::vector<int>{0, 1, 2, 1, 2}));
  EXPECT_EQ(pencil.k, (std::vector<double>{0.0, 5.0, 0.0, 0.0, 0.0}));
  EXPECT_EQ(pencil.m, (std::vector<double>{0.0, 0.0, 2.0, 3.0, 0.0}));
  const std::vector<double> x{1.0, 10.0, 100.0};
  std::vector<double> y(3);
  multiply(pencil, 2.0, x.data(), 1, y.data());
  EXPECT_EQ(y, (std::vector<double>{50.0 - 400.0, 5.0 - 60.0, -4.0}));
  EXPECT_EQ(row_scales(pencil, 2.0), (std::vector<double>{5.0, 6.0, 4.0}));
}

TEST(Permuted, MovesBothMatrices) {
  const SparseMatrix K = random_sparse(60, 5.0, 8);
  const SparseMatrix M = random_sparse(60, 3.0, 9);
  const std::vector<int> order = shuffled(60);
  const Pencil pencil = make_pencil(K, M);
  const Pencil moved = permuted(pencil, order);
  std::vector<double> x(60);
  std::vector<double> mixed(60);
  for (int i = 0; i < 60; ++i) x[i] = 1.0 + i % 7;
  for (int i = 0; i < 60; ++i) mixed[i] = x[order[i]];
  std::vector<double> y(60);
  std::vector<double> of_mixed(60);
  multiply(pencil, 0.7, x.data(), 1, y.data());
  multiply(moved, 0.7, mixed.data(), 1, of_mixed.data());
  for (int i = 0; i < 60; ++i) EXPECT_NEAR(of_mixed[i], y[order[i]], 1e-13);
}

}  // namespace
}  // namespace timbre::detail
