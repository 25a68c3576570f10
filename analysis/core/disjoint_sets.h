#pragma once

#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace timbre {

/// Items 0 to count - 1 in sets that only grow together. Each set is known by its smallest item.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  [[nodiscard]] std::int32_t root(std::int32_t item) {
    while (parent(item) != item) item = parent(item) = parent(parent(item));
    return item;
  }

  void join(std::int32_t a, std::int32_t b) {
    a = root(a);
    b = root(b);
    if (a > b) std::swap(a, b);
    parent(b) = a;
  }

 private:
  std::int32_t& parent(std::int32_t item) { return parent_[static_cast<std::size_t>(item)]; }

  std::vector<std::int32_t> parent_;
};

}  // namespace timbre
