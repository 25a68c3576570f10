#pragma once

#include <filesystem>
#include <string>

namespace timbre {

/// Where the public data sets lie beside the checkout, if they do; tests that need
/// them skip with a word where they do not.
inline std::filesystem::path shared_data() {
  return std::filesystem::path(TIMBRE_SOURCE_DIR) / ".." / "shared" / "data";
}

}  // namespace timbre

#define TIMBRE_NEEDS_SHARED_DATA(relative)                                     \
  if (!std::filesystem::exists(timbre::shared_data() / (relative))) {          \
    GTEST_SKIP() << "the public data set " << (relative) << " is not present"; \
  }
