#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>

namespace timbre {

/// How far a long computation has come.
struct ProgressStep {
  std::string phase;       ///< a word or two for a person: "eigenpairs"
  std::int64_t done = 0;   ///< units finished
  std::int64_t total = 0;  ///< units in all; 0 if unknown
};

/// Called now and then on the caller's own thread, at most 10 times a second.
/// Returning false asks the computation to stop: it throws `cancelled`.
using Progress = std::function<bool(const ProgressStep&)>;

/// Tells a `Progress` (which may be empty) how far one phase has come.
class ProgressReporter {
 public:
  ProgressReporter(Progress progress, std::string phase, std::int64_t total);

  /// @throws Error  cancelled, when the callback asks to stop
  void advance_to(std::int64_t done);
  void advance() { advance_to(step_.done + 1); }

 private:
  Progress progress_;
  ProgressStep step_;
  std::chrono::steady_clock::time_point last_{};
};

/// The same for work that several threads share: any of them may count and ask whether to
/// stop; the `Progress` is called on the thread that made the object.
class SharedProgress {
 public:
  SharedProgress(Progress progress, std::string phase, std::int64_t total);

  /// To be called now and then by each thread that works.
  /// @throws Error  cancelled
  void tell();
  /// Counts one unit, and tells.
  void finish_one();

 private:
  ProgressReporter reporter_;
  std::string phase_;
  std::thread::id caller_ = std::this_thread::get_id();
  std::atomic<std::int64_t> done_ = 0;
  std::atomic<bool> cancelled_ = false;
};

}  // namespace timbre
