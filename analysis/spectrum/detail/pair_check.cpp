#include "timbre/analysis/spectrum/detail/pair_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>

#include "timbre/analysis/core/matrix_product.h"
#include "timbre/analysis/core/threads.h"
#include "timbre/analysis/spectrum/detail/aligned_array.h"
#include "timbre/analysis/spectrum/detail/row_pieces.h"

namespace timbre::detail {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Some pairs at a time, in memory of their own.
class ErrorsOfSome {
 public:
  ErrorsOfSome(const Pencil& pencil, const std::vector<int>& order, const VectorXd& lumped)
      : pencil_(pencil),
        order_(order),
        lumped_(lumped),
        vectors_(static_cast<std::size_t>(pencil.size) * kPencilWidth),
        rests_(vectors_.size()) {}

  void compute(const PairWindow& pairs, Index first, int count, double* errors) {
    constexpr int kWidth = kPencilWidth;
    std::array<double, kWidth> values{};
    std::array<const double*, kWidth> columns{};
    for (int c = 0; c < kWidth; ++c) {  // the last block repeats its last column
      const Index pair = first + std::min(c, count - 1);
      values[static_cast<std::size_t>(c)] = pairs.value(pair);
      columns[static_cast<std::size_t>(c)] = pairs.column(pair);
    }
    for (int i = 0; i < pencil_.size; ++i) {
      double* const row = vectors_.data() + static_cast<std::ptrdiff_t>(i) * kWidth;
      for (std::size_t c = 0; c < kWidth; ++c) row[c] = columns[c][row_of(i)];
    }
    eigenpair_rests(pencil_, values.data(), vectors_.data(), rests_.data());
    std::array<double, kWidth> sums{};
    for (int i = 0; i < pencil_.size; ++i) {
      const double weight = 1.0 / lumped_[row_of(i)];
      const double* const row = rests_.data() + static_cast<std::ptrdiff_t>(i) * kWidth;
      for (std::size_t c = 0; c < kWidth; ++c) sums[c] += weight * row[c] * row[c];
    }
    for (int c = 0; c < count; ++c) errors[c] = std::sqrt(sums[static_cast<std::size_t>(c)]);
  }

 private:
  [[nodiscard]] int row_of(int i) const {
    return order_.empty() ? i : order_[static_cast<std::size_t>(i)];
  }

  const Pencil& pencil_;
  const std::vector<int>& order_;
  const VectorXd& lumped_;
  AlignedArray vectors_;
  AlignedArray rests_;
};

}  // namespace

VectorXd pair_errors(const Pencil& pencil, const std::vector<int>& order, const VectorXd& lumped,
                     const PairWindow& pairs, Index first, Index count, int threads) {
  VectorXd errors(count);
  const Index workers = threads > 0 ? threads : hardware_threads();
  parallel_for(workers, threads, [&](std::int64_t worker) {
    std::optional<ErrorsOfSome> some;
    for (Index done = worker * kPencilWidth; done < count; done += workers * kPencilWidth) {
      if (!some) some.emplace(pencil, order, lumped);
      some->compute(pairs, first + done,
                    static_cast<int>(std::min<Index>(kPencilWidth, count - done)),
                    errors.data() + done);
    }
  });
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

OrthonormalityCheck::OrthonormalityCheck(const Eigen::SparseMatrix<double>& M, int threads)
    : mass_(M), threads_(threads) {}

double OrthonormalityCheck::worst_of(const PairWindow& pairs, Index before, Index begin,
                                     Index count) const {
  const MatrixXd mass_fresh = mass_ * pairs.vectors(begin, count);
  MatrixXd gram = product_at_b(pairs.vectors(before, begin + count - before), mass_fresh);
  gram.bottomRows(count) -= MatrixXd::Identity(count, count);
  const double worst = largest(gram);
  if (before == 0) return worst;
  const MatrixXd products = product_at_b(sums_, mass_fresh);
  const MatrixXd means = products.colwise().norm() / std::sqrt(static_cast<double>(kSums));
  return std::max(worst, largest(means));
}

void OrthonormalityCheck::add(const PairWindow& pairs, Index before, Index first, Index count) {
  constexpr Index kColumns = 16;  // at a time, so that M times them needs little memory
  if (sums_.size() == 0) sums_.setZero(pairs.rows(), kSums);
  const Index groups = (count + kColumns - 1) / kColumns;
  VectorXd worst(groups);
  parallel_for(groups, threads_, [&](std::int64_t group) {
    const Index done = group * kColumns;
    worst[group] = worst_of(pairs, before, first + done, std::min(kColumns, count - done));
  });
  worst_ = std::max(worst_, largest(worst));
  const MatrixXd signs = random_signs(first, count);
  for_each_piece(static_cast<int>(pairs.rows()), threads_, [&](int, int begin, int end) {
    sums_.middleRows(begin, end - begin) +=
        product_a_b(pairs.vectors(first, count).middleRows(begin, end - begin), signs);
  });
}

}  // namespace timbre::detail
