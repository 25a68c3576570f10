#include "timbre/analysis/mesh/detail/grouping.h"

namespace timbre::detail {
namespace {

constexpr std::int32_t kNone = -1;

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
    : slots_(with_huge_pages<Slot>(std::bit_ceil(2 * expected + 64))), recent_(kRecent) {}

void PositionTable::number(std::span<const Position> positions, GrowingRows<Points>& known,
                           std::int32_t* numbers) {
  hashes_.resize(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    hashes_[i] = hash_of_position(positions[i].data());
    prefetch(&slots_[(hashes_[i] >> 32U) & (slots_.size() - 1)]);
  }
  for (std::size_t i = 0; i < positions.size(); ++i) {
    numbers[i] = number_of(positions[i], hashes_[i], known);
  }
}

std::int32_t PositionTable::number_of(const Position& position, std::uint64_t hash,
                                      GrowingRows<Points>& known) {
  // Less than one step is usual. Only a file made for it takes many.
  constexpr std::int64_t kSteps = 16;
  if (budget_ < 0) return ordered_number_of(position, known);
  budget_ += kSteps;
  const auto tag = static_cast<std::uint32_t>(hash);
  Slot& recent = recent_[hash % kRecent];
  if (recent.number != kNone && recent.tag == tag && position_of(known, recent.number) == position)
    return recent.number;
  Slot& slot = slots_[find(position, hash, known)];
  const bool is_new = slot.number == kNone;
  if (is_new) slot = {add(position, known), tag};
  recent = slot;
  if (is_new && 2 * known.size() / 3 > slots_.size()) rebuild(2 * slots_.size(), known);
  return recent.number;
}

std::size_t PositionTable::find(const Position& position, std::uint64_t hash,
                                const GrowingRows<Points>& known) {
  const std::size_t mask = slots_.size() - 1;
  const auto tag = static_cast<std::uint32_t>(hash);
  const auto is_other = [&](const Slot& slot) {
    return slot.tag != tag || position_of(known, slot.number) != position;
  };
  std::size_t at = (hash >> 32U) & mask;
  for (; slots_[at].number != kNone && is_other(slots_[at]); --budget_) at = (at + 1) & mask;
  return at;
}

void PositionTable::rebuild(std::size_t size, const GrowingRows<Points>& known) {
  slots_ = with_huge_pages<Slot>(size);
  const auto count = static_cast<std::int32_t>(known.size() / 3);
  for (std::int32_t i = 0; i < count; ++i) {
    const Position position = position_of(known, i);
    const std::uint64_t hash = hash_of_position(position.data());
    slots_[find(position, hash, known)] = {i, static_cast<std::uint32_t>(hash)};
  }
}

std::int32_t PositionTable::ordered_number_of(const Position& position,
                                              GrowingRows<Points>& known) {
  const auto count = static_cast<std::int32_t>(known.size() / 3);
  for (auto i = static_cast<std::int32_t>(ordered_.size()); i < count; ++i) {
    ordered_.emplace(position_of(known, i), i);
  }
  const auto [at, is_new] = ordered_.emplace(position, count);
  if (is_new) add(position, known);
  return at->second;
}

}  // namespace timbre::detail
