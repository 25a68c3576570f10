#pragma once

#include <cstdint>
#include <initializer_list>
#include <random>
#include <string_view>
#include <vector>

namespace timbre {

/// Random numbers that are the same on every machine, which the distributions of the
/// standard library are not.
class Random {
 public:
  /// @param topic    streams of different topics are unrelated
  /// @param numbers  likewise
  Random(std::string_view topic, std::initializer_list<std::uint64_t> numbers);

  /// In [low, high).
  [[nodiscard]] double uniform(double low, double high);

  /// Of the normal distribution, mean 0 and variance 1.
  [[nodiscard]] double normal();

  /// 0 to n - 1 in random order.
  [[nodiscard]] std::vector<std::int32_t> permutation(std::int32_t n);

 private:
  std::mt19937_64 bits_;
};

}  // namespace timbre
