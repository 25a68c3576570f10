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

SharedProgress::SharedProgress(Progress progress, std::string phase, std::int64_t total)
    : reporter_(std::move(progress), phase, total), phase_(std::move(phase)) {}

void SharedProgress::tell() {
  if (cancelled_) throw Error(ErrorKind::cancelled, "", phase_, "stopped on request");
  if (std::this_thread::get_id() != caller_) return;
  try {
    reporter_.advance_to(done_);
  } catch (...) {
    cancelled_ = true;
    throw;
  }
}

void SharedProgress::finish_one() {
  ++done_;
  tell();
}

}  // namespace timbre
