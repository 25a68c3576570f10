#include "timbre/analysis/core/huge_pages.h"

#include <memory>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace timbre {

void prefer_huge_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  constexpr std::size_t kHuge = std::size_t{2} << 20U;
  // Only pages that lie inside as a whole, so that no neighbour grows.
  if (std::align(kHuge, kHuge, memory, bytes) == nullptr) return;
  (void)::madvise(memory, bytes / kHuge * kHuge, MADV_HUGEPAGE);  // it is fine to be refused
#endif
}

}  // namespace timbre
