#include "timbre/datasets/random.h"

#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace timbre {

Random::Random(std::string_view topic, std::initializer_list<std::uint64_t> numbers) {
  std::vector<std::uint32_t> words(topic.begin(), topic.end());
  for (const std::uint64_t number : numbers) {
    words.push_back(static_cast<std::uint32_t>(number));
    words.push_back(static_cast<std::uint32_t>(number >> 32));
  }
  std::seed_seq seeds(words.begin(), words.end());
  bits_.seed(seeds);
}

double Random::uniform(double low, double high) {
  constexpr double kUnit = 0x1p-53;
  return low + (high - low) * kUnit * static_cast<double>(bits_() >> 11);
}

// Box and Muller 1958.
double Random::normal() {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(0.0, 1.0)));
  return radius * std::cos(2.0 * std::numbers::pi * uniform(0.0, 1.0));
}

std::vector<std::int32_t> Random::permutation(std::int32_t n) {
  std::vector<std::int32_t> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[bits_() % i]);
  return order;
}

}  // namespace timbre
