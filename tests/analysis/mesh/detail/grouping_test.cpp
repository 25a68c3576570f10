#include "timbre/analysis/mesh/detail/grouping.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace timbre::detail {
namespace {

TEST(FirstEqual, FindsTheFirstWhateverTheBuckets) {
  std::mt19937 random(3);
  for (const std::size_t buckets : {1U, 7U, 100U}) {
    std::vector<std::size_t> values(500);
    for (auto& value : values) value = random() % 90;
    const auto first = first_equal(
        values.size(), buckets, [&](std::size_t i) { return values[i] % buckets; },
        [&](std::size_t i, std::size_t j) { return values[i] < values[j]; });
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto expected = std::find(values.begin(), values.end(), values[i]) - values.begin();
      ASSERT_EQ(first[i], expected);
    }
  }
}

TEST(FirstAtPosition, KnowsOneZeroAndNoTolerance) {
  const double next = std::nextafter(1.0, 2.0);
  const std::vector<double> xyz = {0.0, 1.0, 0.0, -0.0, 1.0, -0.0, 0.0, next, 0.0, 0.0, 1.0, 0.0};
  EXPECT_EQ(first_at_position(xyz.data(), 4), (std::vector<std::int32_t>{0, 0, 2, 0}));
  EXPECT_TRUE(first_at_position(nullptr, 0).empty());
}

}  // namespace
}  // namespace timbre::detail
