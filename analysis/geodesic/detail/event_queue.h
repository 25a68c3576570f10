#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace timbre::detail {

/// A queue of events by distance, for fronts that never go back: an event pushed before the
/// one that was popped last counts as being at the same distance. Of equal ones the order is
/// that of a fixed rule, so that runs repeat exactly.
///
/// Doubles that are not negative are in the order of their bits. Events lie in buckets by the
/// highest bit in which they differ from the last one popped, and move to lower buckets as it
/// comes nearer: no comparisons of far events (a radix heap).
///
/// @see Ahuja, Mehlhorn, Orlin and Tarjan 1990
template <typename Payload>
class EventQueue {
 public:
  struct Event {
    double at = 0.0;
    Payload payload{};
  };

  [[nodiscard]] bool empty() const { return size_ == 0; }

  void clear() {
    for (auto& bucket : buckets_) bucket.clear();
    last_ = 0;
    size_ = 0;
  }

  /// @param at  >= 0
  void push(double at, Payload payload) {
    const std::uint64_t key = std::max(std::bit_cast<std::uint64_t>(at), last_);
    buckets_[bucket_of(key)].push_back({key, payload});
    ++size_;
  }

  /// The nearest event; there must be one.
  Event pop() {
    if (buckets_[0].empty()) refill();
    const Entry entry = buckets_[0].back();
    buckets_[0].pop_back();
    --size_;
    return {std::bit_cast<double>(entry.key), entry.payload};
  }

 private:
  struct Entry {
    std::uint64_t key = 0;
    Payload payload{};
  };

  [[nodiscard]] std::size_t bucket_of(std::uint64_t key) const {
    return static_cast<std::size_t>(std::bit_width(key ^ last_));
  }

  void refill() {
    const auto first = std::find_if(buckets_.begin(), buckets_.end(),
                                    [](const auto& bucket) { return !bucket.empty(); });
    last_ = std::min_element(first->begin(), first->end(), [](const Entry& a, const Entry& b) {
              return a.key < b.key;
            })->key;
    for (const Entry& entry : *first) buckets_[bucket_of(entry.key)].push_back(entry);
    first->clear();
  }

  std::array<std::vector<Entry>, 65> buckets_;
  std::uint64_t last_ = 0;
  std::size_t size_ = 0;
};

}  // namespace timbre::detail
