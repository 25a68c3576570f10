// How long do the lowest eigenpairs of a surface take?
//
//   cmake --preset release -DTIMBRE_BENCHMARKS=ON
//   cmake --build build/release --target spectrum_benchmark
//   build/release/benchmarks/spectrum_benchmark
//
// The peer is what most C++ programs do: Spectra's shift-invert Lanczos with one vector at a
// time, on a factor of CHOLMOD (supernodal, METIS) or of Eigen (SimplicialLDLT), at its usual
// tolerance of 1e-10. It counts nothing; timbre's time has the certificate in it. Both get the
// same matrices. Times are those of the processor, on one thread.
#include <Spectra/SymGEigsShiftSolver.h>
#include <benchmark/benchmark.h>

#include <Eigen/SparseCholesky>
#include <cmath>

#ifdef TIMBRE_WITH_CHOLMOD
#include <Eigen/CholmodSupport>
#endif

#include "timbre/analysis/core/threads.h"
#include "timbre/analysis/operators/operator.h"
#include "timbre/analysis/spectrum/spectrum.h"
#include "timbre/datasets/analytic.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Operator operator_of(const benchmark::State& state) {
  const auto frequency = std::sqrt(static_cast<double>(state.range(0)) / 10.0);
  return compute_operator(make_ellipsoid(1.0, 0.8, 0.6, static_cast<int>(std::lround(frequency))));
}

// max over pairs of |W x - l M x| in the norm of the inverse lumped mass, over l + l_k.
double largest_residual(const Operator& op, const VectorXd& values, const MatrixXd& vectors) {
  const MatrixXd errors = op.stiffness * vectors - op.mass * vectors * values.asDiagonal();
  double worst = 0.0;
  for (Index i = 0; i < values.size(); ++i) {
    const double error = std::sqrt((errors.col(i).array().square() / op.lumped_mass.array()).sum());
    worst = std::max(worst, error / (values[i] + values.maxCoeff()));
  }
  return worst;
}

void report(benchmark::State& state, const Operator& op, const VectorXd& values,
            const MatrixXd& vectors) {
  state.counters["vertices"] = static_cast<double>(op.stiffness.rows());
  state.counters["residual"] = largest_residual(op, values, vectors);
}

void Timbre(benchmark::State& state) {
  const Operator op = operator_of(state);
  Spectrum spectrum;
  for (auto _ : state) spectrum = compute_spectrum(op, {.count = static_cast<int>(state.range(1))});
  report(state, op, spectrum.values, spectrum.vectors);
}

template <typename Factor>
class ShiftInverse {
 public:
  using Scalar = double;
  explicit ShiftInverse(const SparseMatrix& matrix) : factor_(matrix) {}
  [[nodiscard]] Index rows() const { return factor_.rows(); }
  [[nodiscard]] Index cols() const { return factor_.cols(); }
  void set_shift(double) {}
  void perform_op(const double* x, double* y) const {
    Eigen::Map<VectorXd>(y, rows()) = factor_.solve(Eigen::Map<const VectorXd>(x, rows()));
  }

 private:
  Factor factor_;
};

class MassProduct {
 public:
  using Scalar = double;
  explicit MassProduct(const VectorXd& mass) : mass_(mass) {}
  [[nodiscard]] Index rows() const { return mass_.size(); }
  [[nodiscard]] Index cols() const { return mass_.size(); }
  void perform_op(const double* x, double* y) const {
    Eigen::Map<VectorXd>(y, rows()) = mass_.cwiseProduct(Eigen::Map<const VectorXd>(x, rows()));
  }

 private:
  const VectorXd& mass_;
};

template <typename Factor>
void run_spectra(benchmark::State& state) {
  const SingleThreadedBlas blas;
  const Operator op = operator_of(state);
  const double shift = -0.1 / op.area;
  const Index count = state.range(1);
  VectorXd values;
  MatrixXd vectors;
  for (auto _ : state) {
    ShiftInverse<Factor> inverse(SparseMatrix(op.stiffness - shift * op.mass));
    MassProduct mass(op.lumped_mass);
    Spectra::SymGEigsShiftSolver<ShiftInverse<Factor>, MassProduct, Spectra::GEigsMode::ShiftInvert>
        solver(inverse, mass, count, 2 * count + 1, shift);
    solver.init();
    solver.compute(Spectra::SortRule::LargestMagn, 1000, 1e-10, Spectra::SortRule::SmallestAlge);
    values = solver.eigenvalues();
    vectors = solver.eigenvectors();
  }
  report(state, op, values, vectors);
}

void SpectraSimplicial(benchmark::State& state) {
  run_spectra<Eigen::SimplicialLDLT<SparseMatrix>>(state);
}

void sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"vertices", "k"})->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
  benchmark->Args({10000, 100})->Args({50000, 100})->Args({10000, 300})->Args({50000, 300});
}

BENCHMARK(Timbre)->Apply(sizes);
BENCHMARK(SpectraSimplicial)->Apply(sizes);
#ifdef TIMBRE_WITH_CHOLMOD
void SpectraCholmod(benchmark::State& state) {
  run_spectra<Eigen::CholmodSupernodalLLT<SparseMatrix>>(state);
}
BENCHMARK(SpectraCholmod)->Apply(sizes);
#endif

}  // namespace
}  // namespace timbre
