// Part of builds with CHOLMOD only.
#include <cholmod.h>

#include <Eigen/Core>
#include <algorithm>
#include <new>

#include "timbre/analysis/spectrum/detail/simplicial_factor.h"

namespace timbre::detail {
namespace {

using Matrix = SimplicialLdlt::Matrix;

// Shares the arrays of an Eigen matrix, of which CHOLMOD reads the lower half.
cholmod_sparse view_of(const Matrix& matrix) {
  cholmod_sparse view{};
  view.nrow = static_cast<std::size_t>(matrix.rows());
  view.ncol = static_cast<std::size_t>(matrix.cols());
  view.nzmax = static_cast<std::size_t>(matrix.nonZeros());
  view.p = const_cast<int*>(matrix.outerIndexPtr());
  view.i = const_cast<int*>(matrix.innerIndexPtr());
  view.x = const_cast<double*>(matrix.valuePtr());
  view.stype = -1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

cholmod_dense view_of(Eigen::MatrixXd& matrix) {
  cholmod_dense view{};
  view.nrow = static_cast<std::size_t>(matrix.rows());
  view.ncol = static_cast<std::size_t>(matrix.cols());
  view.nzmax = static_cast<std::size_t>(matrix.size());
  view.d = view.nrow;
  view.x = matrix.data();
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  return view;
}

// CHOLMOD's settings, workspace and factor, freed together.
class CholmodLdlt final : public SimplicialLdlt {
 public:
  CholmodLdlt() {
    cholmod_start(&common_);
    common_.print = 0;
    common_.final_ll = 0;
    common_.supernodal = CHOLMOD_SIMPLICIAL;  // only this takes pivots of both signs
  }
  ~CholmodLdlt() override {
    cholmod_free_factor(&factor_, &common_);
    for (cholmod_dense** work : {&x_, &y_, &e_}) cholmod_free_dense(work, &common_);
    cholmod_finish(&common_);
  }
  CholmodLdlt(const CholmodLdlt&) = delete;
  CholmodLdlt& operator=(const CholmodLdlt&) = delete;

  std::vector<double> factorize(const Matrix& A) override {
    cholmod_sparse view = view_of(A);
    if (factor_ == nullptr) factor_ = cholmod_analyze(&view, &common_);
    if (factor_ != nullptr) cholmod_factorize(&view, factor_, &common_);
    if (common_.status == CHOLMOD_OUT_OF_MEMORY || common_.status == CHOLMOD_TOO_LARGE) {
      throw std::bad_alloc();
    }
    const bool is_complete =
        factor_ != nullptr && common_.status == CHOLMOD_OK && factor_->minor == factor_->n;
    if (!is_complete) return {};
    const auto* const start = static_cast<const int*>(factor_->p);
    const auto* const values = static_cast<const double*>(factor_->x);
    std::vector<double> pivots(factor_->n);
    for (std::size_t j = 0; j < pivots.size(); ++j) pivots[j] = values[start[j]];
    return pivots;
  }

  void solve(Eigen::MatrixXd& X) const override {
    cholmod_dense view = view_of(X);
    if (cholmod_solve2(CHOLMOD_A, factor_, &view, nullptr, &x_, nullptr, &y_, &e_, &common_) == 0) {
      throw std::bad_alloc();
    }
    std::copy_n(static_cast<const double*>(x_->x), X.size(), X.data());
  }

 private:
  mutable cholmod_common common_{};
  cholmod_factor* factor_ = nullptr;
  mutable cholmod_dense* x_ = nullptr;  // the three are CHOLMOD's workspace, kept between solves
  mutable cholmod_dense* y_ = nullptr;
  mutable cholmod_dense* e_ = nullptr;
};

}  // namespace

std::unique_ptr<SimplicialLdlt> make_cholmod_ldlt() { return std::make_unique<CholmodLdlt>(); }

}  // namespace timbre::detail
