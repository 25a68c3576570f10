#include "timbre/datasets/random.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace timbre {
namespace {

// Stored numbers: the standard fixes mt19937_64 and seed_seq, so any machine must agree.
TEST(Random, IsTheSameEverywhere) {
  Random random("topic", {1, 2});
  EXPECT_EQ(random.permutation(6), (std::vector<std::int32_t>{0, 1, 4, 3, 2, 5}));
  EXPECT_NEAR(random.uniform(-1.0, 1.0), 0.317772, 1e-6);
}

TEST(Random, StreamsDifferByTopicAndByNumbers) {
  const double usual = Random("topic", {1}).uniform(0.0, 1.0);
  EXPECT_EQ(Random("topic", {1}).uniform(0.0, 1.0), usual);
  EXPECT_NE(Random("other", {1}).uniform(0.0, 1.0), usual);
  EXPECT_NE(Random("topic", {2}).uniform(0.0, 1.0), usual);
}

TEST(Random, NormalHasMean0AndVariance1) {
  Random random("normal", {});
  double sum = 0.0;
  double squares = 0.0;
  constexpr int kCount = 100000;
  for (int i = 0; i < kCount; ++i) {
    const double x = random.normal();
    sum += x;
    squares += x * x;
  }
  EXPECT_NEAR(sum / kCount, 0.0, 0.015);
  EXPECT_NEAR(squares / kCount, 1.0, 0.02);
}

TEST(Random, StaysInRangeAndPermutesAll) {
  Random random("range", {});
  for (int i = 0; i < 1000; ++i) {
    const double x = random.uniform(-2.0, 3.0);
    EXPECT_GE(x, -2.0);
    EXPECT_LT(x, 3.0);
  }
  std::vector<std::int32_t> order = random.permutation(100);
  std::sort(order.begin(), order.end());
  for (std::int32_t i = 0; i < 100; ++i) EXPECT_EQ(order[static_cast<std::size_t>(i)], i);
}

}  // namespace
}  // namespace timbre
