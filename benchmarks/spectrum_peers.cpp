// One solver on one pair of matrices; benchmarks/spectrum_peers.py calls it.
//
//   spectrum_peers SOLVER FOLDER K SHIFT OUT
//
// SOLVER: timbre, spectra-simplicial, spectra-cholmod or arpack-cholmod. FOLDER holds the sparse
// matrices W and M as NumPy arrays, with `component` and `positions` of their rows. Writes
// OUT.values.npy, OUT.vectors.npy, and OUT.json with what the solver took, all of it before the
// first byte is written: processor seconds of all threads and the highest memory so far.
//
// timbre's time has the certificate in it; the peers count nothing. They invert W - SHIFT M once
// and go on one vector at a time, in a basis of 2 K + 1, at their usual tolerances: 1e-10 of
// Spectra, full precision of ARPACK.
#include <Spectra/MatOp/SparseSymMatProd.h>
#include <Spectra/SymGEigsShiftSolver.h>

#include <Eigen/CholmodSupport>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <arpack/arpack.hpp>
#include <array>
#include <ctime>
#include <fstream>
#include <iostream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "timbre/analysis/core/array_file.h"
#include "timbre/analysis/core/byte_source.h"
#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/output_file.h"
#include "timbre/analysis/core/threads.h"
#include "timbre/analysis/operators/operator.h"
#include "timbre/analysis/spectrum/spectrum.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Eigen::VectorXi;

constexpr int kRestarts = 1000;

struct Problem {
  Operator op;
  int count = 0;
  double shift = 0.0;  // of the peers

  [[nodiscard]] int size() const { return static_cast<int>(op.stiffness.rows()); }
  [[nodiscard]] int basis() const { return std::min(2 * count + 1, size()); }
};

struct Pairs {
  VectorXd values;
  MatrixXd vectors;
  nlohmann::json phases = nlohmann::json::object();
};

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// Not ru_maxrss, which a process inherits from the one that started it.
double peak_megabytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kibibytes = 0.0;
    if (word == "VmHWM:" && status >> kibibytes) return kibibytes * 1024.0 / 1e6;
  }
  throw Error(ErrorKind::io, "/proc/self/status", "VmHWM", "is missing");
}

// ---- timbre

Pairs solve_with_timbre(const Problem& problem) {
  Spectrum found = compute_spectrum(problem.op, {.count = problem.count, .threads = 1});
  return {std::move(found.values), std::move(found.vectors)};
}

// ---- Peers

// METIS: for surfaces the better of CHOLMOD's orderings.
class SupernodalCholmod : public Eigen::CholmodSupernodalLLT<SparseMatrix> {
 public:
  SupernodalCholmod() {
    cholmod().nmethods = 1;
    cholmod().method[0].ordering = CHOLMOD_METIS;
  }
};

// (W - s M)^-1 in the form that Spectra asks for.
template <typename Factor>
class ShiftInverse {
 public:
  using Scalar = double;
  explicit ShiftInverse(const Operator& op) : op_(op) {}
  [[nodiscard]] Index rows() const { return op_.stiffness.rows(); }
  [[nodiscard]] Index cols() const { return rows(); }

  void set_shift(double shift) {
    const double start = processor_seconds();
    factor_.compute(SparseMatrix(op_.stiffness - shift * op_.mass));
    if (factor_.info() != Eigen::Success) {
      throw Error(ErrorKind::not_converged, "", "factorisation", "failed");
    }
    factorisation_ += processor_seconds() - start;
  }

  void perform_op(const double* x, double* y) const {
    const double start = processor_seconds();
    Eigen::Map<VectorXd>(y, rows()) = factor_.solve(Eigen::Map<const VectorXd>(x, rows()));
    solves_ += processor_seconds() - start;
    ++solve_count_;
  }

  [[nodiscard]] nlohmann::json phases() const {
    return {{"factorisation", factorisation_}, {"solves", solves_}, {"solve_count", solve_count_}};
  }

 private:
  const Operator& op_;
  Factor factor_;
  double factorisation_ = 0.0;
  mutable double solves_ = 0.0;
  mutable int solve_count_ = 0;
};

template <typename Factor>
Pairs solve_with_spectra(const Problem& problem) {
  using Inverse = ShiftInverse<Factor>;
  using Mass = Spectra::SparseSymMatProd<double>;
  Inverse inverse(problem.op);
  Mass mass(problem.op.mass);
  Spectra::SymGEigsShiftSolver<Inverse, Mass, Spectra::GEigsMode::ShiftInvert> solver(
      inverse, mass, problem.count, problem.basis(), problem.shift);
  solver.init();
  solver.compute(Spectra::SortRule::LargestMagn, kRestarts, 1e-10, Spectra::SortRule::SmallestAlge);
  if (solver.info() != Spectra::CompInfo::Successful) {
    throw Error(ErrorKind::not_converged, "", "Spectra", "not all pairs converged");
  }
  return {solver.eigenvalues(), solver.eigenvectors(), inverse.phases()};
}

void require_arpack_done(int info, const char* routine) {
  if (info == 0) return;
  throw Error(ErrorKind::not_converged, "", routine, "info is " + std::to_string(info));
}

// Mode 3 of its symmetric driver.
class Arpack {
 public:
  explicit Arpack(const Problem& problem)
      : problem_(problem),
        n_(problem.size()),
        inverse_(problem.op),
        residual_(n_),
        basis_(n_, problem.basis()),
        work_(3 * static_cast<Index>(n_)),
        small_work_(basis_.cols() * (basis_.cols() + 8)),
        image_(n_) {
    inverse_.set_shift(problem.shift);
  }

  Pairs run() {
    iterate();
    return extract();
  }

 private:
  void iterate() {
    int request = 0;
    int info = 0;
    do {
      arpack::saupd(request, arpack::bmat::generalized, n_, arpack::which::largest_magnitude,
                    problem_.count, kTolerance, residual_.data(), problem_.basis(), basis_.data(),
                    n_, parameters_.data(), places_.data(), work_.data(), small_work_.data(),
                    static_cast<int>(small_work_.size()), info);
    } while (answer(request));
    require_arpack_done(info, "dsaupd");
  }

  // What ARPACK asks for, from one place in its work array to another.
  bool answer(int request) {
    const double* x = place(0);
    double* y = place(1);
    switch (request) {
      case -1:
        multiply_by_mass(x, image_.data());
        inverse_.perform_op(image_.data(), y);
        return true;
      case 1:
        inverse_.perform_op(place(2), y);
        return true;
      case 2:
        multiply_by_mass(x, y);
        return true;
      default:
        return false;
    }
  }

  // The vectors take the place of the basis.
  Pairs extract() {
    VectorXd values(problem_.count);
    VectorXi selected(problem_.basis());
    int info = 0;
    arpack::seupd(1, arpack::howmny::ritz_vectors, selected.data(), values.data(), basis_.data(),
                  n_, problem_.shift, arpack::bmat::generalized, n_,
                  arpack::which::largest_magnitude, problem_.count, kTolerance, residual_.data(),
                  problem_.basis(), basis_.data(), n_, parameters_.data(), places_.data(),
                  work_.data(), small_work_.data(), static_cast<int>(small_work_.size()), info);
    require_arpack_done(info, "dseupd");
    basis_.conservativeResize(n_, problem_.count);
    return {std::move(values), std::move(basis_), inverse_.phases()};
  }

  double* place(std::size_t i) { return work_.data() + places_[i] - 1; }

  void multiply_by_mass(const double* x, double* y) const {
    Eigen::Map<VectorXd>(y, n_).noalias() = problem_.op.mass * Eigen::Map<const VectorXd>(x, n_);
  }

  // Full precision, which 0 stands for in Fortran. The C interface takes it by value, so that what
  // the first call puts in place of 0 is lost to the later ones, and nothing ever converges.
  static constexpr double kTolerance = 0.5 * std::numeric_limits<double>::epsilon();

  const Problem& problem_;
  int n_;
  ShiftInverse<SupernodalCholmod> inverse_;
  VectorXd residual_;
  MatrixXd basis_;
  VectorXd work_;
  VectorXd small_work_;
  VectorXd image_;
  std::array<int, 11> parameters_ = {1, 0, kRestarts, 1, 0, 0, 3};
  std::array<int, 14> places_ = {};
};

Pairs solve_with_arpack(const Problem& problem) { return Arpack(problem).run(); }

// ---- Files

MatrixXd read_array(const std::string& folder, const std::string& name) {
  return from_npy(read_bytes(folder + "/" + name + ".npy"));
}

SparseMatrix read_sparse(const std::string& folder, const std::string& name) {
  const VectorXd data = read_array(folder, name + "_data");
  const VectorXi indices = read_array(folder, name + "_indices").cast<int>();
  const VectorXi starts = read_array(folder, name + "_indptr").cast<int>();
  const Index n = starts.size() - 1;
  return Eigen::Map<const SparseMatrix>(n, n, data.size(), starts.data(), indices.data(),
                                        data.data());
}

// A closed surface, or one with nothing held at its boundary, of piecewise linear elements.
Operator read_operator(const std::string& folder) {
  Operator op;
  op.stiffness = read_sparse(folder, "W");
  op.mass = read_sparse(folder, "M");
  op.vertices = op.stiffness.rows();
  op.lumped_mass = op.mass * VectorXd::Ones(op.vertices);
  op.positions = read_array(folder, "positions");
  const VectorXi component = read_array(folder, "component").cast<int>();
  op.component.assign(component.begin(), component.end());
  op.component_area = VectorXd::Zero(component.maxCoeff() + 1);
  for (Index i = 0; i < op.vertices; ++i) op.component_area[component[i]] += op.lumped_mass[i];
  op.has_constants.assign(static_cast<std::size_t>(op.component_area.size()), true);
  op.area = op.lumped_mass.sum();
  op.mass_kind = op.mass.nonZeros() == op.vertices ? MassKind::lumped : MassKind::consistent;
  return op;
}

template <typename Array>
void write_array(const std::string& path, const Array& array) {
  OutputFile file(path, true);
  file.write(npy_header(array.rows(), array.cols()));
  file.write({reinterpret_cast<const char*>(array.data()),
              static_cast<std::size_t>(array.size()) * sizeof(double)});
  file.commit();
}

using Solver = Pairs (*)(const Problem&);

const std::map<std::string_view, Solver> kSolvers = {
    {"timbre", solve_with_timbre},
    {"spectra-simplicial", solve_with_spectra<Eigen::SimplicialLDLT<SparseMatrix>>},
    {"spectra-cholmod", solve_with_spectra<SupernodalCholmod>},
    {"arpack-cholmod", solve_with_arpack},
};

void run(Solver solve, const Problem& problem, const std::string& output) {
  const SingleThreadedBlas blas;
  const double start = processor_seconds();
  const Pairs found = solve(problem);
  const nlohmann::json taken = {{"cpu_seconds", processor_seconds() - start},
                                {"peak_megabytes", peak_megabytes()},
                                {"phases", found.phases}};
  write_array(output + ".values.npy", found.values);
  write_array(output + ".vectors.npy", found.vectors);
  write_file(output + ".json", taken.dump() + "\n", true);
}

}  // namespace
}  // namespace timbre

int main(int argc, char** argv) try {
  if (argc != 6 || !timbre::kSolvers.contains(argv[1])) {
    std::cerr << "usage: spectrum_peers SOLVER FOLDER K SHIFT OUT\nsolvers:";
    for (const auto& [name, solver] : timbre::kSolvers) std::cerr << " " << name;
    std::cerr << "\n";
    return 2;
  }
  const timbre::Problem problem{timbre::read_operator(argv[2]), std::stoi(argv[3]),
                                std::stod(argv[4])};
  timbre::run(timbre::kSolvers.at(argv[1]), problem, argv[5]);
  return 0;
} catch (const std::exception& error) {
  std::cerr << "spectrum_peers: " << error.what() << "\n";
  return 1;
}
