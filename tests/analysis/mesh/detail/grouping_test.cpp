#include "timbre/analysis/mesh/detail/grouping.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <map>
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

TEST(Repeated, FindsEachItemThatIsNotTheFirst) {
  std::mt19937 random(5);
  for (const std::uint64_t spread : {0U, 1U, 57U}) {  // all hashes equal, nearly equal, far apart
    std::vector<std::size_t> values(700);
    for (auto& value : values) value = random() % 900;
    const auto found = repeated(
        values.size(), 10,
        [&](std::size_t i) {
          return ItemKey{values[i] % 10, (values[i] * spread) << 55U};
        },
        [&](std::size_t i, std::size_t j) { return values[i] < values[j]; });
    std::vector<std::int32_t> expected;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto at = values.begin() + static_cast<std::ptrdiff_t>(i);
      if (std::find(values.begin(), at, *at) != at) {
        expected.push_back(static_cast<std::int32_t>(i));
      }
    }
    EXPECT_EQ(found, expected);
  }
}

TEST(RepeatedPositions, KnowsOneZeroAndNoTolerance) {
  const double next = std::nextafter(1.0, 2.0);
  const std::vector<double> xyz = {0.0, 1.0, 0.0, -0.0, 1.0, -0.0, 0.0, next, 0.0, 0.0, 1.0, 0.0};
  EXPECT_EQ(repeated_positions(xyz), (std::vector<std::int32_t>{1, 3}));
  EXPECT_TRUE(repeated_positions({}).empty());
}

// The numbers of positions, next to a plain list of them.
void expect_first_appearances(const std::vector<std::array<double, 3>>& positions) {
  PositionTable table(4);
  GrowingRows<Points> rows;
  std::map<std::array<double, 3>, std::int32_t> expected;
  const std::span all(positions);
  std::size_t begin = 0;
  for (std::size_t block = 1; begin < all.size(); begin += block, block = block * 5 % 997) {
    const auto some = all.subspan(begin, std::min(block, all.size() - begin));
    std::vector<std::int32_t> numbers(some.size());
    table.number(some, rows, numbers.data());
    for (std::size_t i = 0; i < some.size(); ++i) {
      const auto next = static_cast<std::int32_t>(expected.size());
      ASSERT_EQ(numbers[i], expected.emplace(some[i], next).first->second);
    }
  }
  ASSERT_EQ(rows.size(), 3 * expected.size());
  for (const auto& [position, number] : expected) {
    const auto row = rows.numbers().subspan(3 * static_cast<std::size_t>(number), 3);
    EXPECT_TRUE(std::equal(row.begin(), row.end(), position.begin()));
  }
}

TEST(PositionTable, NumbersByFirstAppearance) {
  std::mt19937 random(9);
  std::vector<std::array<double, 3>> positions(20000);
  for (auto& position : positions) {
    for (double& c : position) c = static_cast<double>(random() % 17);
  }
  expect_first_appearances(positions);
}

// Takes back one step of the hash.
std::uint64_t unmixed(std::uint64_t state) {
  constexpr std::uint64_t kInverse = 0xf1de83e19937733dU;  // of the factor, modulo 2^64
  return (state ^ (state >> 32U)) * kInverse;
}

TEST(PositionTable, StaysFastWhenAFileIsMadeToCollide) {
  std::vector<std::array<double, 3>> positions;
  std::mt19937_64 random(2);
  std::uint64_t before_z = 0x94d049bb133111ebU;
  while (positions.size() < 30000) {
    std::array<double, 3> position = {1.0 + 0x1p-40 * static_cast<double>(random() % 1000000), 1.0};
    std::uint64_t state = before_z;
    for (int k = 0; k < 2; ++k) {
      state = mixed(state, std::bit_cast<std::uint64_t>(position[static_cast<std::size_t>(k)]));
    }
    position[2] = std::bit_cast<double>(unmixed(12345) ^ state);
    if (!std::isfinite(position[2])) continue;
    ASSERT_EQ(hash_of_position(position.data()), 12345 * 0xbf58476d1ce4e5b9U);
    positions.push_back(position);
  }
  for (int k = 0; k < 20000; ++k) positions.push_back(positions[29000]);
  expect_first_appearances(positions);  // hours if each walked past all before it
}

}  // namespace
}  // namespace timbre::detail
