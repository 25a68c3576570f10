#include "timbre/analysis/core/memory_budget.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace timbre {
namespace {

constexpr std::int64_t kUnknown = std::numeric_limits<std::int64_t>::max();

std::int64_t available_in_system() {
  std::ifstream file("/proc/meminfo");
  std::string name;
  std::string unit;
  for (std::int64_t kib = 0; file >> name >> kib; std::getline(file, unit)) {
    if (name == "MemAvailable:") return kib * 1024;
  }
  return kUnknown;
}

// One number in a file; "max", a missing file and all else are `kUnknown`.
std::int64_t number_in(const std::string& path) {
  std::ifstream file(path);
  std::int64_t number = 0;
  return file >> number ? number : kUnknown;
}

std::int64_t available_in_group() {
  const std::int64_t limit = number_in("/sys/fs/cgroup/memory.max");
  const std::int64_t used = number_in("/sys/fs/cgroup/memory.current");
  return limit == kUnknown || used == kUnknown ? kUnknown : std::max<std::int64_t>(1, limit - used);
}

}  // namespace

std::int64_t available_memory() {
  const std::int64_t bytes = std::min(available_in_system(), available_in_group());
  return bytes == kUnknown ? 0 : bytes;
}

MemoryBudget::Share MemoryBudget::take(std::int64_t bytes) {
  std::unique_lock lock(mutex_);
  freed_.wait(lock, [&] { return limit_ == 0 || held_ == 0 || held_ + bytes <= limit_; });
  held_ += bytes;
  return {*this, bytes};
}

void MemoryBudget::give_back(std::int64_t bytes) {
  const std::lock_guard lock(mutex_);
  held_ -= bytes;
  freed_.notify_all();
}

}  // namespace timbre
