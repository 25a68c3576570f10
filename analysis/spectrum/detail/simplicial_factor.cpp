#include "timbre/analysis/spectrum/detail/simplicial_factor.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "timbre/analysis/spectrum/detail/factor_check.h"

namespace timbre::detail {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Matrix = SimplicialLdlt::Matrix;

class EigenLdlt final : public SimplicialLdlt {
 public:
  std::vector<double> factorize(const Matrix& A) override {
    if (factor_.rows() == 0) factor_.analyzePattern(A);
    factor_.factorize(A);
    if (factor_.info() != Eigen::Success) return {};
    const Eigen::VectorXd pivots = factor_.vectorD();
    return {pivots.begin(), pivots.end()};
  }
  void solve(MatrixXd& X) const override { X = factor_.solve(X).eval(); }

 private:
  Eigen::SimplicialLDLT<Matrix> factor_;
};

class SimplicialFactor final : public ShiftedFactor {
 public:
  SimplicialFactor(const Matrix& K, const Matrix& M, std::unique_ptr<SimplicialLdlt> ldlt)
      : pencil_(make_pencil(K, M)),
        order_(static_cast<std::size_t>(pencil_.size)),
        shifted_(pencil_.size, pencil_.size),
        ldlt_(std::move(ldlt)) {
    std::iota(order_.begin(), order_.end(), 0);
    shifted_.resizeNonZeros(pencil_.entries());
    std::copy(pencil_.start.begin(), pencil_.start.end(), shifted_.outerIndexPtr());
    std::copy(pencil_.row.begin(), pencil_.row.end(), shifted_.innerIndexPtr());
  }

  LdltReport factorize(double shift) override {
    double* const values = shifted_.valuePtr();
    for (std::size_t e = 0; e < pencil_.k.size(); ++e) {
      values[e] = pencil_.k[e] - shift * pencil_.m[e];
    }
    LdltReport report{.shift = shift};
    const std::vector<double> pivots = ldlt_->factorize(shifted_);
    double least = std::numeric_limits<double>::infinity();
    double largest = 0.0;
    for (const double pivot : pivots) {
      report.negative += pivot < 0.0 ? 1 : 0;
      least = std::min(least, std::abs(pivot));
      largest = std::max(largest, std::abs(pivot));
    }
    // A pivot this small beside the largest has lost its sign to rounding.
    report.smallest_pivot = least / largest;
    report.near_singular = std::ssize(pivots) < pencil_.size || !(report.smallest_pivot > 1e-15);
    if (report.near_singular) return report;
    const FactorCheck check = check_factor(
        pencil_, shift, [this](double* X, int width) { solve_in_factor_order(X, width); });
    report.backward_error = check.backward_error;
    report.residual = check.residual;
    report.near_singular = is_doubtful(check.residual);
    return report;
  }

  void solve_in_factor_order(double* X, int width) const override {
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<Rows> rows(X, pencil_.size, width);
    MatrixXd columns = rows;
    ldlt_->solve(columns);
    rows = columns;
  }

  [[nodiscard]] const std::vector<int>& order() const override { return order_; }
  [[nodiscard]] const Pencil& pencil() const override { return pencil_; }

 private:
  Pencil pencil_;
  std::vector<int> order_;
  Matrix shifted_;  // the lower triangle
  std::unique_ptr<SimplicialLdlt> ldlt_;
};

}  // namespace

std::unique_ptr<SimplicialLdlt> make_eigen_ldlt() { return std::make_unique<EigenLdlt>(); }

std::unique_ptr<ShiftedFactor> make_simplicial_factor(const Matrix& K, const Matrix& M,
                                                      std::unique_ptr<SimplicialLdlt> ldlt) {
  return std::make_unique<SimplicialFactor>(K, M, std::move(ldlt));
}

}  // namespace timbre::detail
