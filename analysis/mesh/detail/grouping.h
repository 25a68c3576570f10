#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "timbre/analysis/core/huge_pages.h"
#include "timbre/analysis/mesh/detail/growing_rows.h"
#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre::detail {

/// How many items ahead of their use they are fetched, where each is somewhere else in memory.
inline constexpr std::size_t kAhead = 16;

inline void prefetch([[maybe_unused]] const void* memory) {
#if defined(__GNUC__)
  __builtin_prefetch(memory);
#endif
}

/// For each of `count` items, the first item equal to it (often itself). Items are dealt
/// into `buckets` and sorted in each: linear where the buckets spread them, and
/// O(count log count) comparisons whatever the input, so that no file can make it slow.
///
/// @param bucket_of  item -> [0, buckets); equal items share a bucket
/// @param less       a strict weak order of items; neither less means equal
template <typename BucketOf, typename Less>
std::vector<std::int32_t> first_equal(std::size_t count, std::size_t buckets, BucketOf bucket_of,
                                      Less less) {
  // First the sizes of the buckets, then where each begins, at last where each ends.
  std::vector<std::size_t> end_of(buckets + 1, 0);
  std::vector<std::uint32_t> bucket(count);
  for (std::size_t i = 0; i < count; ++i) {
    bucket[i] = static_cast<std::uint32_t>(bucket_of(i));
    ++end_of[bucket[i] + 1];
  }
  for (std::size_t b = 0; b < buckets; ++b) end_of[b + 1] += end_of[b];
  std::vector<std::int32_t> order(count);
  for (std::size_t i = 0; i < count; ++i) {
    order[end_of[bucket[i]]++] = static_cast<std::int32_t>(i);
  }

  const auto before = [&](std::int32_t a, std::int32_t b) {
    const auto i = static_cast<std::size_t>(a);
    const auto j = static_cast<std::size_t>(b);
    if (less(i, j)) return true;
    return !less(j, i) && a < b;
  };
  std::vector<std::int32_t> first(count);
  for (std::size_t b = 0; b < buckets; ++b) {
    const auto begin = order.begin() + static_cast<std::ptrdiff_t>(b == 0 ? 0 : end_of[b - 1]);
    const auto end = order.begin() + static_cast<std::ptrdiff_t>(end_of[b]);
    if (end - begin > 1) std::sort(begin, end, before);
    std::int32_t leader = 0;
    for (auto at = begin; at != end; ++at) {
      const bool is_new =
          at == begin || less(static_cast<std::size_t>(leader), static_cast<std::size_t>(*at));
      if (is_new) leader = *at;
      first[static_cast<std::size_t>(*at)] = leader;
    }
  }
  return first;
}

/// Where an item is looked for first, and what tells it from the others there.
struct ItemKey {
  std::size_t bucket = 0;
  std::uint64_t hash = 0;
};

/// The items equal to an earlier one, ascending. Each item leaves one of 64 marks in its
/// bucket, and only those whose mark was left twice are compared: fast where few items are
/// equal, and O(count log count) comparisons whatever the input.
///
/// @param key_of  item -> bucket in [0, buckets) and hash; equal items have equal keys
/// @param less    a strict weak order of items; neither less means equal
template <typename KeyOf, typename Less>
std::vector<std::int32_t> repeated(std::size_t count, std::size_t buckets, KeyOf key_of,
                                   Less less) {
  constexpr std::size_t kShare = 8;  // few marks are left twice; close together they stay in cache
  std::vector<std::uint64_t> once = with_huge_pages<std::uint64_t>(buckets);
  std::vector<std::uint64_t> again(buckets / kShare + 1);
  const auto mark_of = [](std::uint64_t hash) { return std::uint64_t{1} << (hash >> 58U); };
  std::array<ItemKey, 64> keys;
  for (std::size_t first = 0; first < count; first += keys.size()) {
    const std::size_t here = std::min(keys.size(), count - first);
    for (std::size_t i = 0; i < here; ++i) {
      keys[i] = key_of(first + i);
      prefetch(&once[keys[i].bucket]);
    }
    for (const ItemKey& key : std::span(keys).first(here)) {
      const std::uint64_t mark = mark_of(key.hash);
      if ((once[key.bucket] & mark) != 0) again[key.bucket / kShare] |= mark;
      once[key.bucket] |= mark;
    }
  }

  using Suspect = std::pair<std::uint64_t, std::int32_t>;  // hash and item
  std::vector<Suspect> suspects;
  for (std::size_t i = 0; i < count; ++i) {
    const ItemKey key = key_of(i);
    if ((again[key.bucket / kShare] & mark_of(key.hash)) == 0) continue;
    suspects.emplace_back(key.hash, static_cast<std::int32_t>(i));
  }
  std::sort(suspects.begin(), suspects.end());

  std::vector<std::int32_t> found;
  const auto is_before = [&](const Suspect& a, const Suspect& b) {
    const auto i = static_cast<std::size_t>(a.second);
    const auto j = static_cast<std::size_t>(b.second);
    return less(i, j) || (!less(j, i) && i < j);
  };
  for (auto begin = suspects.begin(); begin != suspects.end();) {
    const auto end = std::find_if(begin, suspects.end(),
                                  [&](const Suspect& s) { return s.first != begin->first; });
    std::sort(begin, end, is_before);
    for (auto at = begin + 1; at < end; ++at) {
      const auto before = static_cast<std::size_t>((at - 1)->second);
      if (!less(before, static_cast<std::size_t>(at->second))) found.push_back(at->second);
    }
    begin = end;
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// Bits that depend on all bits of both.
[[nodiscard]] inline std::uint64_t mixed(std::uint64_t state, std::uint64_t bits) {
  state = (state ^ bits) * 0x9e3779b97f4a7c15U;
  return state ^ (state >> 32U);
}

/// A hash of a position; the same for -0 and 0.
[[nodiscard]] inline std::uint64_t hash_of_position(const double* xyz) {
  std::uint64_t state = 0x94d049bb133111ebU;
  for (int k = 0; k < 3; ++k) state = mixed(state, std::bit_cast<std::uint64_t>(xyz[k] + 0.0));
  return state * 0xbf58476d1ce4e5b9U;
}

/// The positions equal to an earlier one, ascending; -0 equals 0, no tolerance.
[[nodiscard]] std::vector<std::int32_t> repeated_positions(std::span<const double> xyz);

/// Numbers positions in order of first appearance; -0 equals 0, no tolerance.
class PositionTable {
 public:
  using Position = std::array<double, 3>;
  /// @param expected  how many different positions, roughly
  explicit PositionTable(std::size_t expected);
  /// The numbers of some positions, without -0; at least as many `numbers`. `known` holds those
  /// numbered so far, and new ones are added. Fast when it gets some hundreds at once.
  void number(std::span<const Position> positions, GrowingRows<Points>& known,
              std::int32_t* numbers);

 private:
  struct Slot {
    std::int32_t number = -1;
    std::uint32_t tag = 0;  // of the hash, so that few others are looked at
  };
  static constexpr std::size_t kRecent = std::size_t{1} << 12U;
  std::int32_t number_of(const Position& position, std::uint64_t hash, GrowingRows<Points>& known);
  /// The slot of a position, or the empty one where it belongs.
  std::size_t find(const Position& position, std::uint64_t hash, const GrowingRows<Points>& known);
  void rebuild(std::size_t size, const GrowingRows<Points>& known);
  std::int32_t ordered_number_of(const Position& position, GrowingRows<Points>& known);

  std::vector<Slot> slots_;     // a power of two of them, less than half in use
  std::vector<Slot> recent_;    // by hash: facets follow their neighbours, and cache holds it
  std::int64_t budget_ = 1024;  // slots that may still be looked at in vain
  std::vector<std::uint64_t> hashes_;
  std::map<Position, std::int32_t> ordered_;  // in use once the hashes fail
};

}  // namespace timbre::detail
