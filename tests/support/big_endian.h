#pragma once

#include <algorithm>
#include <bit>
#include <cstring>
#include <initializer_list>
#include <string>

namespace timbre {

/// The bytes of each value, most significant first.
template <typename T>
std::string big_endian(std::initializer_list<T> values) {
  std::string bytes;
  for (const T value : values) {
    std::string raw(sizeof value, '\0');
    std::memcpy(raw.data(), &value, sizeof value);
    if (std::endian::native == std::endian::little) std::reverse(raw.begin(), raw.end());
    bytes += raw;
  }
  return bytes;
}

}  // namespace timbre
