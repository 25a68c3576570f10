#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include "timbre/analysis/core/huge_pages.h"

namespace timbre::detail {

/// Numbers that arrive one after the other and end as a matrix of three columns, without a
/// copy at the end: a `std::vector` whose storage Eigen can keep.
template <typename Matrix>
class GrowingRows {
 public:
  using Number = typename Matrix::Scalar;

  void reserve_rows(std::size_t rows) {
    if (3 * rows <= capacity()) return;
    rows_.conservativeResize(static_cast<Eigen::Index>(rows), 3);
    prefer_huge_pages(rows_.data() + size_, (capacity() - size_) * sizeof(Number));
  }
  void push_back(Number number) { extend(1)[0] = number; }
  /// So many more numbers, for the caller to write; valid until the next call.
  Number* extend(std::size_t count) {
    if (count > capacity() - size_) grow(size_ + count);
    size_ += count;
    return rows_.data() + (size_ - count);
  }
  /// Forgets the last numbers.
  void shrink(std::size_t count) { size_ -= count; }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::span<const Number> numbers() const { return {rows_.data(), size_}; }
  /// The rows; a last one that is not whole is lost.
  [[nodiscard]] Matrix take() && {
    rows_.conservativeResize(static_cast<Eigen::Index>(size_ / 3), 3);
    return std::move(rows_);
  }

 private:
  [[nodiscard]] std::size_t capacity() const { return static_cast<std::size_t>(rows_.size()); }
  void grow(std::size_t needed) {
    constexpr std::size_t kLeast = 64;
    reserve_rows(std::max({kLeast, (needed + 2) / 3, capacity() / 3 * 2}));
  }

  Matrix rows_;  // all capacity
  std::size_t size_ = 0;
};

}  // namespace timbre::detail
