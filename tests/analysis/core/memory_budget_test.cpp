#include "timbre/analysis/core/memory_budget.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <future>
#include <thread>

namespace timbre {
namespace {

TEST(AvailableMemory, IsThatOfACommonMachine) {
  const std::int64_t bytes = available_memory();
  EXPECT_GT(bytes, std::int64_t{1} << 20U);
  EXPECT_LT(bytes, std::int64_t{1} << 50U);
}

TEST(MemoryBudget, IsNeverExceededByTwo) {
  MemoryBudget budget(100);
  std::atomic<int> held = 0;
  std::atomic<int> most = 0;
  const auto work = [&](int bytes) {
    for (int i = 0; i < 200; ++i) {
      const auto share = budget.take(bytes);
      const int now = held += bytes;
      for (int before = most; before < now && !most.compare_exchange_weak(before, now);) {
      }
      std::this_thread::yield();
      held -= bytes;
    }
  };
  {
    std::jthread a(work, 60);
    std::jthread b(work, 50);
    std::jthread c(work, 30);
  }
  EXPECT_LE(most, 100);
  EXPECT_GE(most, 60);
}

TEST(MemoryBudget, LetsWorkThatIsTooLargeGoAlone) {
  MemoryBudget budget(100);
  std::atomic<bool> has_small = false;
  std::jthread small;
  {
    const auto large = budget.take(1000);
    small = std::jthread([&] {
      const auto share = budget.take(1);
      has_small = true;
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_FALSE(has_small);
  }
  small.join();
  EXPECT_TRUE(has_small);
}

TEST(MemoryBudget, OfZeroIsNone) {
  MemoryBudget budget(0);
  std::promise<void> taken;
  std::jthread other;
  {
    const auto one = budget.take(1000);
    other = std::jthread([&] {
      const auto two = budget.take(1000);
      taken.set_value();
    });
    EXPECT_EQ(taken.get_future().wait_for(std::chrono::seconds(10)), std::future_status::ready);
  }
}

}  // namespace
}  // namespace timbre
