#pragma once

#include <cstdint>
#include <functional>

namespace timbre {

/// Cores this process may use; at least 1.
[[nodiscard]] int hardware_threads();

/// Calls `work(i)` once for each i in [0, count), on at most `threads` threads
/// (0: all cores), the caller's included. Each i must write to its own place;
/// then the result does not depend on the number of threads. When calls throw,
/// the exception of the smallest i is thrown again, after all threads have ended.
void parallel_for(std::int64_t count, int threads, const std::function<void(std::int64_t)>& work);

/// While one lives, BLAS calls run on the thread that makes them: results do
/// not depend on the machine's cores, and threads of our own do not compete.
/// Restores the former setting when the last one ends.
class SingleThreadedBlas {
 public:
  SingleThreadedBlas();
  ~SingleThreadedBlas();
  SingleThreadedBlas(const SingleThreadedBlas&) = delete;
  SingleThreadedBlas& operator=(const SingleThreadedBlas&) = delete;
};

}  // namespace timbre
