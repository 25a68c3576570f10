#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace timbre::detail {

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

/// For each position the first one equal to it; -0 equals 0, no tolerance.
[[nodiscard]] std::vector<std::int32_t> first_at_position(const double* xyz, std::size_t count);

}  // namespace timbre::detail
