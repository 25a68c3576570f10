#pragma once

#include <cstddef>
#include <vector>

namespace timbre {

/// Asks the system to back this memory, allocated and not yet written, by large pages. The first
/// touch of each small page costs microseconds on virtual machines, several times what it takes
/// to write the page. Only advice, for a few megabytes and more: nothing else changes, and where
/// the system does not know it nothing happens.
void prefer_huge_pages(void* memory, std::size_t bytes);

/// A vector of so many values, all of them T{}, on such pages.
template <typename T>
[[nodiscard]] std::vector<T> with_huge_pages(std::size_t count) {
  std::vector<T> values;
  values.reserve(count);
  prefer_huge_pages(values.data(), count * sizeof(T));
  values.resize(count);
  return values;
}

}  // namespace timbre
