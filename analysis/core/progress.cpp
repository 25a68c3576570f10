#include "timbre/analysis/core/progress.h"

#include <utility>

#include "timbre/analysis/core/error.h"

namespace timbre {

ProgressReporter::ProgressReporter(Progress progress, std::string phase, std::int64_t total)
    : progress_(std::move(progress)), step_{std::move(phase), 0, total} {}

void ProgressReporter::advance_to(std::int64_t done) {
  step_.done = done;
  if (!progress_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - last_ < std::chrono::milliseconds(100) && done != step_.total) return;
  last_ = now;
  if (!progress_(step_)) throw Error(ErrorKind::cancelled, "", step_.phase, "stopped on request");
}

}  // namespace timbre
