#include "timbre/tests/fuzz/memory_watch.h"

#if defined(__SANITIZE_ADDRESS__)
#define TIMBRE_COUNTS_MEMORY
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define TIMBRE_COUNTS_MEMORY
#endif
#endif

#ifdef TIMBRE_COUNTS_MEMORY
#include <algorithm>

// Of sanitizer/allocator_interface.h, which Debian's g++ does not bring.
extern "C" {
int __sanitizer_install_malloc_and_free_hooks(void (*)(const volatile void*, std::size_t),
                                              void (*)(const volatile void*));
std::size_t __sanitizer_get_allocated_size(const volatile void*);
}
#endif

namespace timbre::fuzz {
namespace {

bool watching = false;
std::ptrdiff_t taken = 0;
std::ptrdiff_t most_taken = 0;

#ifdef TIMBRE_COUNTS_MEMORY

void on_malloc(const volatile void*, std::size_t size) {
  if (!watching) return;
  taken += static_cast<std::ptrdiff_t>(size);
  most_taken = std::max(most_taken, taken);
}

void on_free(const volatile void* block) {
  if (!watching || block == nullptr) return;
  taken -= static_cast<std::ptrdiff_t>(__sanitizer_get_allocated_size(block));
}

const int installed = __sanitizer_install_malloc_and_free_hooks(on_malloc, on_free);

#endif

}  // namespace

MemoryWatch::MemoryWatch() {
  taken = 0;
  most_taken = 0;
  watching = true;
}

MemoryWatch::~MemoryWatch() { watching = false; }

std::size_t MemoryWatch::peak() const { return static_cast<std::size_t>(most_taken); }

}  // namespace timbre::fuzz
