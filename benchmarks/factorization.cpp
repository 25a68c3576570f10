// How long do ordering, factorisation and solves of K - s M take, beside CHOLMOD and Eigen?
//
//   cmake --preset release -DTIMBRE_BENCHMARKS=ON
//   cmake --build build/release --target factorization_benchmark
//   build/release/benchmarks/factorization_benchmark
//
// One thread. `shape` 0: a sphere; 1: an ellipsoid of axes 1, 0.5, 4. CHOLMOD is supernodal LL^T of
// the definite K + M, with its METIS ordering; Eigen's SimplicialLDLT, with AMD, and CHOLMOD's
// simplicial LDL^T are those of the indefinite matrix near the 50th eigenvalue. `backward`: the
// backward error of the last solve. Times of one factorisation are of the second and later ones.
#include <benchmark/benchmark.h>
#include <cholmod.h>

#include <Eigen/SparseCholesky>
#include <map>
#include <memory>
#include <utility>

#include "timbre/analysis/core/threads.h"
#include "timbre/analysis/operators/operator.h"
#include "timbre/analysis/spectrum/detail/supernodal_ldlt.h"
#include "timbre/datasets/analytic.h"

namespace timbre {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using detail::OrderingMethod;
using detail::SupernodalLdlt;

struct Problem {
  TriangleMesh mesh;
  Operator op;
  double shift = 0.0;  // about the 50th eigenvalue, by Weyl's law

  [[nodiscard]] Matrix at(double s) const { return op.stiffness - s * op.mass; }
};

const Problem& problem(const benchmark::State& state) {
  static std::map<std::pair<int, int>, Problem> made;
  const std::pair key{static_cast<int>(state.range(0)), static_cast<int>(state.range(1))};
  Problem& p = made[key];
  if (p.mesh.vertices.rows() == 0) {
    p.mesh = key.first == 0 ? make_sphere(key.second) : make_ellipsoid(1.0, 0.5, 4.0, key.second);
    p.op = compute_operator(p.mesh);
    p.shift = 4.0 * 3.14159265358979 * 50.3 / p.op.mass.diagonal().sum();
  }
  return p;
}

double backward_error(const Matrix& A, const Eigen::MatrixXd& X, const Eigen::MatrixXd& B) {
  const double norm = (A.cwiseAbs() * Eigen::VectorXd::Ones(A.cols())).maxCoeff();
  return (A * X - B).norm() / (norm * X.norm() + B.norm());
}

Eigen::MatrixXd right_hand_sides(Eigen::Index n, Eigen::Index count) {
  std::srand(1);
  return Eigen::MatrixXd::Random(n, count);
}

SupernodalLdlt ours(const Problem& p, OrderingMethod ordering, int threads = 1) {
  return {p.op.stiffness,
          p.op.mass,
          &p.mesh.vertices,
          {.ordering = ordering, .threads = threads, .check = false}};
}

void OursAnalyse(benchmark::State& state, OrderingMethod ordering) {
  const Problem& p = problem(state);
  for (auto _ : state) {
    const SupernodalLdlt ldlt = ours(p, ordering);
    state.counters["entries"] = static_cast<double>(ldlt.symbolic().entries);
    state.counters["flops"] = ldlt.symbolic().flops;
    state.counters["bytes"] = static_cast<double>(ldlt.bytes());
  }
}

void OursFactorize(benchmark::State& state, OrderingMethod ordering, bool definite, int threads) {
  const Problem& p = problem(state);
  SupernodalLdlt ldlt = ours(p, ordering, threads);
  const double shift = definite ? -1.0 : p.shift;
  ldlt.factorize(shift);
  for (auto _ : state) {
    state.counters["negative"] = static_cast<double>(ldlt.factorize(shift).negative);
  }
  state.counters["flops/s"] =
      benchmark::Counter(ldlt.symbolic().flops, benchmark::Counter::kIsIterationInvariantRate);
}

void OursSolve(benchmark::State& state, OrderingMethod ordering, int count) {
  const Problem& p = problem(state);
  SupernodalLdlt ldlt = ours(p, ordering);
  ldlt.factorize(p.shift);
  const Eigen::MatrixXd B = right_hand_sides(p.op.stiffness.rows(), count);
  Eigen::MatrixXd X;
  for (auto _ : state) {
    X = B;
    ldlt.solve(X);
  }
  state.counters["backward"] = backward_error(p.at(p.shift), X, B);
}

void OursSolveInFactorOrder(benchmark::State& state, OrderingMethod ordering, int count) {
  const Problem& p = problem(state);
  SupernodalLdlt ldlt = ours(p, ordering);
  ldlt.factorize(p.shift);
  Eigen::MatrixXd X = right_hand_sides(count, p.op.stiffness.rows());  // transposed: by rows
  for (auto _ : state) {
    ldlt.solve_in_factor_order(X.data(), count);
    state.PauseTiming();
    X /= X.norm();
    state.ResumeTiming();
  }
}

class Cholmod {
 public:
  Cholmod(const Matrix& A, bool supernodal) : A_(A) {
    cholmod_start(&common_);
    common_.nmethods = 1;
    common_.method[0].ordering = CHOLMOD_METIS;
    common_.supernodal = supernodal ? CHOLMOD_SUPERNODAL : CHOLMOD_SIMPLICIAL;
    common_.final_ll = supernodal ? 1 : 0;
    view_.nrow = static_cast<std::size_t>(A_.rows());
    view_.ncol = view_.nrow;
    view_.nzmax = static_cast<std::size_t>(A_.nonZeros());
    view_.p = A_.outerIndexPtr();
    view_.i = A_.innerIndexPtr();
    view_.x = A_.valuePtr();
    view_.stype = -1;
    view_.itype = CHOLMOD_INT;
    view_.xtype = CHOLMOD_REAL;
    view_.dtype = CHOLMOD_DOUBLE;
    view_.sorted = 1;
    view_.packed = 1;
    factor_ = cholmod_analyze(&view_, &common_);
  }
  ~Cholmod() {
    for (cholmod_dense** work : {&x_, &y_, &e_}) cholmod_free_dense(work, &common_);
    cholmod_free_factor(&factor_, &common_);
    cholmod_finish(&common_);
  }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;

  void factorize() { cholmod_factorize(&view_, factor_, &common_); }
  Eigen::Map<const Eigen::MatrixXd> solve(Eigen::MatrixXd& B) {
    cholmod_dense b{};
    b.nrow = static_cast<std::size_t>(B.rows());
    b.ncol = static_cast<std::size_t>(B.cols());
    b.nzmax = b.nrow * b.ncol;
    b.d = b.nrow;
    b.x = B.data();
    b.xtype = CHOLMOD_REAL;
    b.dtype = CHOLMOD_DOUBLE;
    cholmod_solve2(CHOLMOD_A, factor_, &b, nullptr, &x_, nullptr, &y_, &e_, &common_);
    return {static_cast<const double*>(x_->x), B.rows(), B.cols()};
  }
  [[nodiscard]] double entries() const { return common_.lnz; }

 private:
  Matrix A_;
  cholmod_common common_{};
  cholmod_sparse view_{};
  cholmod_factor* factor_ = nullptr;
  cholmod_dense* x_ = nullptr;
  cholmod_dense* y_ = nullptr;
  cholmod_dense* e_ = nullptr;
};

void CholmodAnalyse(benchmark::State& state) {
  const Matrix A = problem(state).at(-1.0);
  for (auto _ : state) state.counters["entries"] = Cholmod(A, true).entries();
}

void CholmodFactorize(benchmark::State& state, bool supernodal) {
  const SingleThreadedBlas single;
  const Problem& p = problem(state);
  Cholmod peer(p.at(supernodal ? -1.0 : p.shift), supernodal);
  peer.factorize();
  for (auto _ : state) peer.factorize();
}

void CholmodSolve(benchmark::State& state, int count) {
  const SingleThreadedBlas single;
  const Problem& p = problem(state);
  Cholmod peer(p.at(-1.0), true);
  peer.factorize();
  Eigen::MatrixXd B = right_hand_sides(p.op.stiffness.rows(), count);
  for (auto _ : state) benchmark::DoNotOptimize(peer.solve(B).data());
  state.counters["backward"] = backward_error(p.at(-1.0), peer.solve(B), B);
}

void EigenFactorize(benchmark::State& state) {
  const Problem& p = problem(state);
  const Matrix A = p.at(p.shift);
  Eigen::SimplicialLDLT<Matrix> peer;
  peer.analyzePattern(A);
  for (auto _ : state) peer.factorize(A);
}

void EigenSolve(benchmark::State& state, int count) {
  const Problem& p = problem(state);
  const Matrix A = p.at(p.shift);
  const Eigen::SimplicialLDLT<Matrix> peer(A);
  const Eigen::MatrixXd B = right_hand_sides(A.rows(), count);
  Eigen::MatrixXd X;
  for (auto _ : state) X = peer.solve(B);
  state.counters["backward"] = backward_error(A, X, B);
}

void sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"shape", "frequency"})->Unit(benchmark::kMillisecond);
  for (const int frequency : {32, 71, 141}) {  // 10, 50 and 200 thousand vertices
    for (const int shape : {0, 1}) benchmark->Args({shape, frequency});
  }
}

constexpr auto kMetis = OrderingMethod::metis;
constexpr auto kGeometric = OrderingMethod::geometric;

BENCHMARK_CAPTURE(OursAnalyse, geometric, kGeometric)->Apply(sizes);
BENCHMARK_CAPTURE(OursAnalyse, metis, kMetis)->Apply(sizes);
BENCHMARK(CholmodAnalyse)->Apply(sizes);

BENCHMARK_CAPTURE(OursFactorize, geometric_definite, kGeometric, true, 1)->Apply(sizes);
BENCHMARK_CAPTURE(OursFactorize, metis_definite, kMetis, true, 1)->Apply(sizes);
BENCHMARK_CAPTURE(CholmodFactorize, supernodal_definite, true)->Apply(sizes);
BENCHMARK_CAPTURE(OursFactorize, geometric, kGeometric, false, 1)->Apply(sizes);
BENCHMARK_CAPTURE(OursFactorize, metis, kMetis, false, 1)->Apply(sizes);
BENCHMARK_CAPTURE(OursFactorize, metis_two_threads, kMetis, false, 2)->Apply(sizes)->UseRealTime();
BENCHMARK_CAPTURE(CholmodFactorize, simplicial, false)->Apply(sizes);
BENCHMARK(EigenFactorize)->Apply(sizes);

BENCHMARK_CAPTURE(OursSolveInFactorOrder, metis_8, kMetis, 8)->Apply(sizes);
BENCHMARK_CAPTURE(OursSolve, geometric_8, kGeometric, 8)->Apply(sizes);
BENCHMARK_CAPTURE(OursSolve, metis_8, kMetis, 8)->Apply(sizes);
BENCHMARK_CAPTURE(CholmodSolve, supernodal_8, 8)->Apply(sizes);
BENCHMARK_CAPTURE(EigenSolve, 8, 8)->Apply(sizes);
BENCHMARK_CAPTURE(OursSolveInFactorOrder, metis_32, kMetis, 32)->Apply(sizes);
BENCHMARK_CAPTURE(OursSolve, geometric_32, kGeometric, 32)->Apply(sizes);
BENCHMARK_CAPTURE(OursSolve, metis_32, kMetis, 32)->Apply(sizes);
BENCHMARK_CAPTURE(CholmodSolve, supernodal_32, 32)->Apply(sizes);
BENCHMARK_CAPTURE(EigenSolve, 32, 32)->Apply(sizes);

}  // namespace
}  // namespace timbre
