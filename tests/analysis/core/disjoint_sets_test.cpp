#include "timbre/analysis/core/disjoint_sets.h"

#include <gtest/gtest.h>

namespace timbre {
namespace {

TEST(DisjointSets, AreEachKnownByTheirSmallestItem) {
  DisjointSets sets(7);
  EXPECT_EQ(sets.root(4), 4);
  sets.join(5, 2);
  sets.join(6, 5);
  EXPECT_EQ(sets.root(6), 2);
  sets.join(6, 6);
  sets.join(1, 6);
  for (const int item : {1, 2, 5, 6}) EXPECT_EQ(sets.root(item), 1);
  for (const int item : {0, 3, 4}) EXPECT_EQ(sets.root(item), item);
}

TEST(DisjointSets, FindTheEndOfALongChain) {
  constexpr int kCount = 1000;
  DisjointSets sets(kCount);
  for (int i = kCount - 1; i > 0; --i) sets.join(i, i - 1);
  for (int i = 0; i < kCount; ++i) EXPECT_EQ(sets.root(i), 0);
}

}  // namespace
}  // namespace timbre
