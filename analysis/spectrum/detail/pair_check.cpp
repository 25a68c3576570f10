#include "timbre/analysis/spectrum/detail/pair_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "timbre/analysis/core/matrix_product.h"
#include "timbre/analysis/spectrum/detail/aligned_array.h"

namespace timbre::detail {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd pair_errors(const Pencil& pencil, const std::vector<int>& order, const VectorXd& lumped,
                     const PairWindow& pairs, Index first, Index count) {
  constexpr int kWidth = kPencilWidth;
  VectorXd errors(count);
  const auto numbers = static_cast<std::size_t>(pencil.size) * kWidth;
  AlignedArray vectors(numbers);
  AlignedArray rests(numbers);
  const auto row_of = [&](int i) { return order.empty() ? i : order[static_cast<std::size_t>(i)]; };
  for (Index done = 0; done < count; done += kWidth) {
    const auto some = static_cast<int>(std::min<Index>(kWidth, count - done));
    std::array<double, kWidth> values{};
    std::array<const double*, kWidth> columns{};
    for (int c = 0; c < kWidth; ++c) {  // the last block repeats its last column
      const Index pair = first + done + std::min(c, some - 1);
      values[static_cast<std::size_t>(c)] = pairs.value(pair);
      columns[static_cast<std::size_t>(c)] = pairs.column(pair);
    }
    for (int i = 0; i < pencil.size; ++i) {
      double* const row = vectors.data() + static_cast<std::ptrdiff_t>(i) * kWidth;
      for (std::size_t c = 0; c < kWidth; ++c) row[c] = columns[c][row_of(i)];
    }
    eigenpair_rests(pencil, values.data(), vectors.data(), rests.data());
    std::array<double, kWidth> sums{};
    for (int i = 0; i < pencil.size; ++i) {
      const double weight = 1.0 / lumped[row_of(i)];
      const double* const row = rests.data() + static_cast<std::ptrdiff_t>(i) * kWidth;
      for (std::size_t c = 0; c < kWidth; ++c) sums[c] += weight * row[c] * row[c];
    }
    for (int c = 0; c < some; ++c) errors[done + c] = std::sqrt(sums[static_cast<std::size_t>(c)]);
  }
  return errors;
}

namespace {

constexpr Index kSums = 4;

double largest(const MatrixXd& matrix) {
  const double worst = matrix.cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
  // What is not a number counts as infinitely wrong.
  return worst >= 0.0 ? worst : std::numeric_limits<double>::infinity();
}

// Those of a pair depend on its number only.
MatrixXd random_signs(Index first, Index count) {
  MatrixXd signs(count, kSums);
  for (Index i = 0; i < count; ++i) {
    std::mt19937_64 random(static_cast<std::uint64_t>(first + i));
    for (Index s = 0; s < kSums; ++s) signs(i, s) = (random() & 1U) != 0 ? 1.0 : -1.0;
  }
  return signs;
}

}  // namespace

OrthonormalityCheck::OrthonormalityCheck(const Eigen::SparseMatrix<double>& M) : mass_(M) {}

void OrthonormalityCheck::add(const PairWindow& pairs, Index before, Index first, Index count) {
  constexpr Index kColumns = 16;  // at a time, so that M times them needs little memory
  MatrixXd mass_vectors(pairs.rows(), std::min(kColumns, count));
  if (sums_.size() == 0) sums_.setZero(pairs.rows(), kSums);
  for (Index done = 0; done < count; done += kColumns) {
    const Index some = std::min(kColumns, count - done);
    const Index begin = first + done;
    const auto fresh = pairs.vectors(begin, some);
    auto mass_fresh = mass_vectors.leftCols(some);
    mass_fresh.noalias() = mass_ * fresh;
    MatrixXd gram = product_at_b(pairs.vectors(before, begin + some - before), mass_fresh);
    gram.bottomRows(some) -= MatrixXd::Identity(some, some);
    worst_ = std::max(worst_, largest(gram));
    if (before > 0) {
      const MatrixXd products = product_at_b(sums_, mass_fresh);
      const MatrixXd means = products.colwise().norm() / std::sqrt(static_cast<double>(kSums));
      worst_ = std::max(worst_, largest(means));
    }
    sums_ += product_a_b(fresh, random_signs(begin, some));
  }
}

}  // namespace timbre::detail
