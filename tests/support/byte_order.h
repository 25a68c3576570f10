#pragma once

#include <algorithm>
#include <bit>
#include <cstring>
#include <initializer_list>
#include <string>

namespace timbre {

/// The bytes of each value in this order.
template <typename T>
std::string bytes_of(std::initializer_list<T> values, std::endian order) {
  std::string bytes;
  for (const T value : values) {
    std::string raw(sizeof value, '\0');
    std::memcpy(raw.data(), &value, sizeof value);
    if (std::endian::native != order) std::reverse(raw.begin(), raw.end());
    bytes += raw;
  }
  return bytes;
}

template <typename T>
std::string big_endian(std::initializer_list<T> values) {
  return bytes_of(values, std::endian::big);
}

template <typename T>
std::string little_endian(std::initializer_list<T> values) {
  return bytes_of(values, std::endian::little);
}

}  // namespace timbre
