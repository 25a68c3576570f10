#include "timbre/analysis/mesh/detail/grouping.h"

#include <bit>

namespace timbre::detail {
namespace {

// The mixing step of splitmix64.
std::uint64_t mixed(std::uint64_t bits) {
  bits = (bits ^ (bits >> 30U)) * 0xbf58476d1ce4e5b9U;
  bits = (bits ^ (bits >> 27U)) * 0x94d049bb133111ebU;
  return bits ^ (bits >> 31U);
}

std::uint64_t hash(const double* xyz) {
  std::uint64_t state = 0x9e3779b97f4a7c15U;
  for (int k = 0; k < 3; ++k) {
    const double normal = xyz[k] + 0.0;  // makes -0 to 0
    state = mixed(state ^ std::bit_cast<std::uint64_t>(normal)) + 0x9e3779b97f4a7c15U;
  }
  return state;
}

}  // namespace

std::vector<std::int32_t> first_at_position(const double* xyz, std::size_t count) {
  const std::size_t mask = std::bit_ceil(count + 1) - 1;
  const auto bucket_of = [&](std::size_t i) { return hash(xyz + 3 * i) & mask; };
  const auto less = [&](std::size_t i, std::size_t j) {
    return std::lexicographical_compare(xyz + 3 * i, xyz + 3 * i + 3, xyz + 3 * j, xyz + 3 * j + 3);
  };
  return first_equal(count, mask + 1, bucket_of, less);
}

}  // namespace timbre::detail
