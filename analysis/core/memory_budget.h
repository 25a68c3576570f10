#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace timbre {

/// Memory that this process can still take without swapping: what the system has free or can free,
/// and no more than is left below the limit of its control group. 0 if it cannot be known.
[[nodiscard]] std::int64_t available_memory();

/// Memory shared out among threads that know about how much their work will take.
class MemoryBudget {
 public:
  /// @param bytes  that may be held at a time; 0: any
  explicit MemoryBudget(std::int64_t bytes) : limit_(bytes) {}

  /// What is held until this goes.
  class [[nodiscard]] Share {
   public:
    Share(MemoryBudget& budget, std::int64_t bytes) : budget_(&budget), bytes_(bytes) {}
    ~Share() { budget_->give_back(bytes_); }
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;

   private:
    MemoryBudget* budget_;
    std::int64_t bytes_;
  };

  /// Waits until so much is free, or all is: work that needs more than the budget goes alone.
  Share take(std::int64_t bytes);

 private:
  void give_back(std::int64_t bytes);

  std::int64_t limit_;
  std::int64_t held_ = 0;
  std::mutex mutex_;
  std::condition_variable freed_;
};

}  // namespace timbre
