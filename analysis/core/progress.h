#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

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

}  // namespace timbre
