#include "timbre/analysis/spectrum/factorization.h"

#ifdef TIMBRE_WITH_CHOLMOD
#include <cholmod.h>
#endif

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <string>

#include "timbre/analysis/core/error.h"

namespace timbre {

using Matrix = Eigen::SparseMatrix<double>;

struct Factorization::Impl {
  virtual ~Impl() = default;
  virtual void solve(const double* b, double* x) = 0;
};

namespace {

[[noreturn]] void fail(const std::string& cause) {
  throw Error(ErrorKind::not_converged, "", "factorisation", cause);
}

// A pivot this small beside the largest has lost its sign to rounding.
bool is_singular(double least_pivot, double largest_pivot) {
  return !(least_pivot > 1e-15 * largest_pivot);
}

class EigenFactorization final : public Factorization::Impl {
 public:
  explicit EigenFactorization(const Matrix& matrix) : factor_(matrix) {
    if (factor_.info() != Eigen::Success || !(factor_.vectorD().minCoeff() > 0.0)) {
      fail("the matrix is not positive definite");
    }
  }
  void solve(const double* b, double* x) override {
    const Eigen::Index n = factor_.rows();
    Eigen::Map<Eigen::VectorXd>(x, n) = factor_.solve(Eigen::Map<const Eigen::VectorXd>(b, n));
  }

 private:
  Eigen::SimplicialLDLT<Matrix> factor_;
};

std::int64_t count_negative_by_eigen(const Matrix& matrix) {
  const Eigen::SimplicialLDLT<Matrix> factor(matrix);
  if (factor.info() != Eigen::Success) fail("a pivot is 0 at this shift");
  const Eigen::VectorXd pivots = factor.vectorD();
  if (is_singular(pivots.cwiseAbs().minCoeff(), pivots.cwiseAbs().maxCoeff())) {
    fail("a pivot is 0 to rounding at this shift");
  }
  return (pivots.array() < 0.0).count();
}

#ifdef TIMBRE_WITH_CHOLMOD

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

cholmod_dense view_of(const double* values, std::size_t size) {
  cholmod_dense view{};
  view.nrow = size;
  view.ncol = 1;
  view.nzmax = size;
  view.d = size;
  view.x = const_cast<double*>(values);
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  return view;
}

// CHOLMOD's settings, workspace and factor, freed together.
class CholmodFactor {
 public:
  CholmodFactor(const Matrix& matrix, bool indefinite) {
    cholmod_start(&common_);
    common_.print = 0;
    common_.final_ll = indefinite ? 0 : 1;  // LL^T, so that a negative pivot is refused
    if (indefinite) common_.supernodal = CHOLMOD_SIMPLICIAL;  // only this has both signs
    cholmod_sparse view = view_of(matrix);
    factor_ = cholmod_analyze(&view, &common_);
    if (factor_ != nullptr) cholmod_factorize(&view, factor_, &common_);
    if (common_.status == CHOLMOD_OUT_OF_MEMORY || common_.status == CHOLMOD_TOO_LARGE) {
      release();
      throw std::bad_alloc();
    }
  }
  ~CholmodFactor() { release(); }
  CholmodFactor(const CholmodFactor&) = delete;
  CholmodFactor& operator=(const CholmodFactor&) = delete;

  [[nodiscard]] bool complete() const {
    return factor_ != nullptr && common_.status == CHOLMOD_OK && factor_->minor == factor_->n;
  }

  cholmod_common common_{};
  cholmod_factor* factor_ = nullptr;

 private:
  void release() {
    cholmod_free_factor(&factor_, &common_);
    cholmod_finish(&common_);
  }
};

class CholmodFactorization final : public Factorization::Impl {
 public:
  explicit CholmodFactorization(const Matrix& matrix) : held_(matrix, false) {
    if (!held_.complete()) fail("the matrix is not positive definite");
  }
  ~CholmodFactorization() override {
    for (cholmod_dense** work : {&x_, &y_, &e_}) cholmod_free_dense(work, &held_.common_);
  }
  CholmodFactorization(const CholmodFactorization&) = delete;
  CholmodFactorization& operator=(const CholmodFactorization&) = delete;

  void solve(const double* b, double* x) override {
    const std::size_t n = held_.factor_->n;
    cholmod_dense view = view_of(b, n);
    if (cholmod_solve2(CHOLMOD_A, held_.factor_, &view, nullptr, &x_, nullptr, &y_, &e_,
                       &held_.common_) == 0) {
      throw std::bad_alloc();
    }
    std::copy_n(static_cast<const double*>(x_->x), n, x);
  }

 private:
  CholmodFactor held_;
  cholmod_dense* x_ = nullptr;  // the three are CHOLMOD's workspace, kept between solves
  cholmod_dense* y_ = nullptr;
  cholmod_dense* e_ = nullptr;
};

std::int64_t count_negative_by_cholmod(const Matrix& matrix) {
  const CholmodFactor held(matrix, true);
  if (!held.complete()) fail("a pivot is 0 at this shift");
  const auto* const start = static_cast<const int*>(held.factor_->p);
  const auto* const values = static_cast<const double*>(held.factor_->x);
  std::int64_t negative = 0;
  double least = std::numeric_limits<double>::infinity();
  double largest = 0.0;
  for (std::size_t j = 0; j < held.factor_->n; ++j) {
    const double pivot = values[start[j]];
    negative += pivot < 0.0 ? 1 : 0;
    least = std::min(least, std::abs(pivot));
    largest = std::max(largest, std::abs(pivot));
  }
  if (is_singular(least, largest)) fail("a pivot is 0 to rounding at this shift");
  return negative;
}

#endif

bool use_cholmod(FactorizationBackend backend) {
  if (backend == FactorizationBackend::cholmod && !has_cholmod()) {
    throw Error(ErrorKind::bad_request, "", "factorisation",
                "this build of timbre has no CHOLMOD; choose 'eigen' or 'automatic'");
  }
  return backend != FactorizationBackend::eigen && has_cholmod();
}

}  // namespace

bool has_cholmod() {
#ifdef TIMBRE_WITH_CHOLMOD
  return true;
#else
  return false;
#endif
}

Factorization::Factorization(const Matrix& matrix, FactorizationBackend backend) {
#ifdef TIMBRE_WITH_CHOLMOD
  if (use_cholmod(backend)) {
    impl_ = std::make_unique<CholmodFactorization>(matrix);
    return;
  }
#else
  (void)use_cholmod(backend);
#endif
  impl_ = std::make_unique<EigenFactorization>(matrix);
}

Factorization::~Factorization() = default;
Factorization::Factorization(Factorization&&) noexcept = default;
Factorization& Factorization::operator=(Factorization&&) noexcept = default;

void Factorization::solve(const double* b, double* x) { impl_->solve(b, x); }

std::int64_t count_negative_eigenvalues(const Matrix& matrix, FactorizationBackend backend) {
#ifdef TIMBRE_WITH_CHOLMOD
  if (use_cholmod(backend)) return count_negative_by_cholmod(matrix);
#else
  (void)use_cholmod(backend);
#endif
  return count_negative_by_eigen(matrix);
}

}  // namespace timbre
