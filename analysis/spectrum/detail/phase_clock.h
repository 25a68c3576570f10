#pragma once

#include <utility>

#include "timbre/analysis/core/stopwatch.h"
#include "timbre/analysis/spectrum/spectrum.h"

namespace timbre::detail {

/// Wall time by phase: each moment belongs to one.
class PhaseClock {
 public:
  using Phase = double SpectrumPhases::*;

  /// Until this goes, time belongs to a phase; then to that from before.
  class [[nodiscard]] Scope {
   public:
    /// @param clock  nullptr: nothing is measured
    Scope(PhaseClock* clock, Phase phase) : clock_(clock) {
      if (clock_ != nullptr) before_ = clock_->go_to(phase);
    }
    ~Scope() {
      if (clock_ != nullptr) (void)clock_->go_to(before_);
    }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    PhaseClock* clock_;
    Phase before_ = nullptr;
  };

  [[nodiscard]] const SpectrumPhases& seconds() const { return seconds_; }

 private:
  Phase go_to(Phase phase) {
    const double lap = watch_.lap();
    if (now_ != nullptr) seconds_.*now_ += lap;
    return std::exchange(now_, phase);
  }

  SpectrumPhases seconds_;
  Stopwatch watch_;
  Phase now_ = nullptr;  // of none
};

}  // namespace timbre::detail
