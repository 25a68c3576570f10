#include "timbre/analysis/core/huge_pages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

namespace timbre {
namespace {

TEST(PreferHugePages, TakesMemoryOfAnySizeAndPlaceAndChangesNothing) {
  std::vector<char> memory(std::size_t{9} << 20U, 'x');
  for (const std::size_t begin : {0U, 1U, 4096U, 5000000U}) {
    for (const std::size_t size : {0U, 1U, 4096U, 4000000U}) {
      prefer_huge_pages(memory.data() + begin, size);
    }
  }
  EXPECT_EQ(std::count(memory.begin(), memory.end(), 'x'), std::ssize(memory));
  prefer_huge_pages(nullptr, 0);
}

TEST(WithHugePages, GivesFreshValues) {
  struct Slot {
    std::int32_t number = -1;
  };
  for (const std::size_t count : {0U, 3U, 3000000U}) {
    const auto slots = with_huge_pages<Slot>(count);
    EXPECT_EQ(slots.size(), count);
    EXPECT_TRUE(
        std::all_of(slots.begin(), slots.end(), [](const Slot& s) { return s.number == -1; }));
  }
}

}  // namespace
}  // namespace timbre
