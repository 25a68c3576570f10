#include "timbre/analysis/spectrum/detail/pair_window.h"

#include <algorithm>
#include <utility>

#include "timbre/analysis/core/huge_pages.h"

namespace timbre::detail {

using Eigen::Index;

// Large blocks are moved by the system without a copy.
void PairWindow::grow(Index columns) {
  vectors_.conservativeResize(rows_, columns);
  prefer_huge_pages(vectors_.data(), static_cast<std::size_t>(vectors_.size()) * sizeof(double));
}

void PairWindow::reserve(Index count) {
  if (vectors_.cols() < count) grow(count);
}

void PairWindow::append(Index count) {
  const Index used = std::ssize(values_);
  if (used + count > vectors_.cols()) grow(std::max(used + count, used + used / 2));
  values_.resize(static_cast<std::size_t>(used + count));
}

void PairWindow::drop_before(Index first) {
  const Index gone = std::min(first, end()) - first_;
  if (gone <= 0) return;
  std::copy(column(first_ + gone), vectors_.data() + std::ssize(values_) * rows_, vectors_.data());
  values_.erase(values_.begin(), values_.begin() + gone);
  first_ += gone;
}

Eigen::MatrixXd PairWindow::release(Index count) {
  vectors_.conservativeResize(Eigen::NoChange, count);
  values_.clear();
  return std::exchange(vectors_, {});
}

}  // namespace timbre::detail
