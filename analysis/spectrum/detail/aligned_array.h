#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>

#include "timbre/analysis/core/huge_pages.h"

namespace timbre::detail {

struct AlignedFree {
  std::align_val_t alignment{64};
  void operator()(double* p) const { ::operator delete(p, alignment); }
};

/// Numbers without initial values, aligned for vector instructions, on huge pages where there
/// are many. Unlike a vector it touches no page before its owner writes there.
class AlignedArray {
 public:
  AlignedArray() = default;
  explicit AlignedArray(std::size_t size) : size_(size) {
    const std::size_t bytes = size * sizeof(double);
    const std::align_val_t alignment{bytes > kHuge ? kHuge : std::size_t{64}};
    values_ = {static_cast<double*>(::operator new(std::max<std::size_t>(bytes, 64), alignment)),
               AlignedFree{alignment}};
    prefer_huge_pages(values_.get(), bytes);
  }

  [[nodiscard]] double* data() { return values_.get(); }
  [[nodiscard]] const double* data() const { return values_.get(); }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  static constexpr std::size_t kHuge = std::size_t{2} << 20U;
  std::unique_ptr<double, AlignedFree> values_;
  std::size_t size_ = 0;
};

}  // namespace timbre::detail
