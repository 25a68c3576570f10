#include "timbre/analysis/spectrum/detail/pair_window.h"

#include <algorithm>
#include <utility>

namespace timbre::detail {

using Eigen::Index;

void PairWindow::append(Index count) {
  const std::size_t used = values_.size() * static_cast<std::size_t>(rows_);
  const std::size_t needed = used + static_cast<std::size_t>(count * rows_);
  if (needed > vectors_.size()) {
    AlignedArray larger(std::max(needed, used + used / 2));
    std::copy_n(vectors_.data(), used, larger.data());
    vectors_ = std::move(larger);
  }
  values_.resize(values_.size() + static_cast<std::size_t>(count));
}

void PairWindow::drop_before(Index first) {
  const Index gone = std::min(first, end()) - first_;
  if (gone <= 0) return;
  const std::size_t skipped = static_cast<std::size_t>(gone * rows_);
  const std::size_t used = values_.size() * static_cast<std::size_t>(rows_);
  std::copy(vectors_.data() + skipped, vectors_.data() + used, vectors_.data());
  values_.erase(values_.begin(), values_.begin() + gone);
  first_ += gone;
}

}  // namespace timbre::detail
