#include "timbre/analysis/mesh/detail/grouping.h"

namespace timbre::detail {
namespace {

std::array<double, 3> position_of(const GrowingRows<Points>& positions, std::int32_t number) {
  const double* const xyz = positions.numbers().data() + 3 * static_cast<std::size_t>(number);
  return {xyz[0], xyz[1], xyz[2]};
}

std::int32_t add(const std::array<double, 3>& position, GrowingRows<Points>& positions) {
  const auto number = static_cast<std::int32_t>(positions.size() / 3);
  std::copy(position.begin(), position.end(), positions.extend(3));
  return number;
}

}  // namespace

std::vector<std::int32_t> repeated_positions(std::span<const double> xyz) {
  const std::size_t count = xyz.size() / 3;
  const std::size_t mask = std::bit_ceil(count / 4 + 1) - 1;
  const auto position = [&](std::size_t i) { return xyz.data() + 3 * i; };
  return repeated(
      count, mask + 1,
      [&](std::size_t i) {
        const std::uint64_t hash = hash_of_position(position(i));
        return ItemKey{(hash >> 32U) & mask, hash};
      },
      [&](std::size_t i, std::size_t j) {
        return std::lexicographical_compare(position(i), position(i) + 3, position(j),
                                            position(j) + 3);
      });
}

PositionTable::PositionTable(std::size_t expected)
    : slots_(std::bit_ceil(2 * expected + 64), kEmpty) {}

std::int32_t PositionTable::number_of(const std::array<double, 3>& position,
                                      GrowingRows<Points>& positions) {
  // Less than one step is usual. Only a file made for it takes many.
  constexpr std::int64_t kSteps = 16;
  if (budget_ < 0) return ordered_number_of(position, positions);
  budget_ += kSteps;
  const std::size_t at = find(position, positions);
  if (slots_[at] != kEmpty) return slots_[at];
  const std::int32_t number = slots_[at] = add(position, positions);
  if (2 * positions.size() / 3 > slots_.size()) rebuild(2 * slots_.size(), positions);
  return number;
}

std::size_t PositionTable::find(const std::array<double, 3>& position,
                                const GrowingRows<Points>& positions) {
  const std::size_t mask = slots_.size() - 1;
  std::size_t at = (hash_of_position(position.data()) >> 32U) & mask;
  for (; slots_[at] != kEmpty && position_of(positions, slots_[at]) != position; --budget_) {
    at = (at + 1) & mask;
  }
  return at;
}

void PositionTable::rebuild(std::size_t size, const GrowingRows<Points>& positions) {
  slots_.assign(size, kEmpty);
  const auto count = static_cast<std::int32_t>(positions.size() / 3);
  for (std::int32_t i = 0; i < count; ++i) slots_[find(position_of(positions, i), positions)] = i;
}

std::int32_t PositionTable::ordered_number_of(const std::array<double, 3>& position,
                                              GrowingRows<Points>& positions) {
  const auto count = static_cast<std::int32_t>(positions.size() / 3);
  for (auto i = static_cast<std::int32_t>(ordered_.size()); i < count; ++i) {
    ordered_.emplace(position_of(positions, i), i);
  }
  const auto [at, is_new] = ordered_.emplace(position, count);
  if (is_new) add(position, positions);
  return at->second;
}

}  // namespace timbre::detail
