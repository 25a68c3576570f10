// How far are eigenvalues from closed forms? Prints the table of docs/operators.md:
//
//   cmake --build build/release --target convergence && build/release/tests/convergence
//
// Elements of degree d are put on a mesh d times as coarse: those in a row have equally many nodes.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iomanip>
#include <iostream>
#include <numbers>
#include <string>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/operators/operator.h"
#include "timbre/analysis/spectrum/spectrum.h"
#include "timbre/datasets/analytic.h"
#include "timbre/datasets/closed_form.h"

namespace {

using timbre::BoundaryKind;
using timbre::MassKind;
using timbre::OperatorKind;
using timbre::OperatorOptions;

constexpr int kNonzero = 20;  // eigenvalues compared, from the lowest
// Steps from node to node along a radius, half a side, ...; for whole cells of all degrees each is
// divisible by 2 and 3.
constexpr std::array kNodes = {12, 24, 48};

struct Element {
  const char* name;
  OperatorKind kind;
  MassKind mass;
  int degree;
};

constexpr std::array kElements = {
    Element{"P1 lumped", OperatorKind::cotan, MassKind::lumped, 1},
    Element{"P1 consistent", OperatorKind::cotan, MassKind::consistent, 1},
    Element{"P2", OperatorKind::p2, MassKind::consistent, 2},
    Element{"P3", OperatorKind::p3, MassKind::consistent, 3}};

struct Problem {
  timbre::Operator op;
  double width = 0.0;  // the longest edge
};

struct Surface {
  std::string name;
  BoundaryKind boundary;
  std::vector<double> exact;                                     // without zero, ascending
  std::function<Problem(int cells, const OperatorOptions&)> at;  // `cells` along a radius, ...
};

struct Result {
  Eigen::Index unknowns = 0;
  double width = 0.0;
  double error = 0.0;  // the largest, relative
};

double longest_edge(const timbre::TriangleMesh& mesh) {
  double longest = 0.0;
  for (const auto& face : mesh.faces.rowwise()) {
    for (int c = 0; c < 3; ++c) {
      const auto edge = mesh.vertices.row(face[c]) - mesh.vertices.row(face[(c + 1) % 3]);
      longest = std::max(longest, edge.norm());
    }
  }
  return longest;
}

Problem on_mesh(const timbre::TriangleMesh& mesh, const OperatorOptions& options) {
  return {timbre::compute_operator(mesh, options), longest_edge(mesh)};
}

Problem on_sphere(int cells, const OperatorOptions& options) {
  return on_mesh(timbre::make_sphere(cells), options);
}

Problem on_disk(int cells, const OperatorOptions& options) {
  return on_mesh(timbre::make_disk(cells), options);
}

Problem on_rectangle(int cells, const OperatorOptions& options) {
  return on_mesh(timbre::make_rectangle(2.0, 1.0, 2 * cells, cells), options);
}

Problem on_flat_torus(int cells, const OperatorOptions& options) {
  const timbre::IntrinsicMesh torus = timbre::make_flat_torus(2 * cells);
  return {timbre::compute_operator(torus.faces, torus.lengths, torus.vertices, options),
          torus.lengths.maxCoeff()};
}

// pi^2 (i^2 / 4 + j^2), i and j from 1 on.
std::vector<double> rectangle_with_fixed_boundary() {
  std::vector<double> values;
  for (int i = 1; i <= kNonzero; ++i) {
    for (int j = 1; j <= kNonzero; ++j) {
      values.push_back(std::numbers::pi * std::numbers::pi * (0.25 * i * i + j * j));
    }
  }
  std::sort(values.begin(), values.end());
  values.resize(kNonzero);
  return values;
}

std::vector<double> without_zero(std::vector<double> values) {
  values.erase(values.begin());
  return values;
}

std::vector<Surface> all_surfaces() {
  constexpr int kCount = kNonzero + 1;
  return {{"flat torus, side 1", BoundaryKind::neumann,
           without_zero(timbre::flat_torus_eigenvalues(kCount)), on_flat_torus},
          {"rectangle 2 x 1, Neumann", BoundaryKind::neumann,
           without_zero(timbre::rectangle_eigenvalues(2.0, 1.0, kCount)), on_rectangle},
          {"rectangle 2 x 1, Dirichlet", BoundaryKind::dirichlet, rectangle_with_fixed_boundary(),
           on_rectangle},
          {"disk, radius 1, Neumann", BoundaryKind::neumann,
           without_zero(timbre::disk_eigenvalues(kCount)), on_disk},
          {"sphere, radius 1", BoundaryKind::neumann,
           without_zero(timbre::sphere_eigenvalues(kCount)), on_sphere}};
}

double largest_error(const timbre::Operator& op, const std::vector<double>& exact) {
  const int zeros = timbre::count_zeros(op);
  const timbre::Spectrum found = timbre::compute_spectrum(op, {.count = zeros + kNonzero});
  const auto wanted = Eigen::Map<const Eigen::ArrayXd>(exact.data(), kNonzero);
  return (found.values.tail(kNonzero).array() / wanted - 1.0).abs().maxCoeff();
}

Result solve(const Surface& surface, const Element& element, int nodes) {
  const OperatorOptions options = {
      .kind = element.kind, .mass = element.mass, .boundary = surface.boundary};
  const auto [op, width] = surface.at(nodes / element.degree, options);
  // Nodes on a Dirichlet boundary have no part.
  return {(op.lumped_mass.array() > 0.0).count(), width, largest_error(op, surface.exact)};
}

using Row = std::array<Result, kElements.size()>;

Row solve_all(const Surface& surface, int nodes) {
  Row row;
  for (std::size_t e = 0; e < row.size(); ++e) row[e] = solve(surface, kElements[e], nodes);
  return row;
}

void print_header() {
  std::cout << "| surface | unknowns | h of P1, P2, P3 |";
  for (const Element& element : kElements) std::cout << ' ' << element.name << " |";
  std::cout << "\n| --- | --- | --- | --- | --- | --- | --- |\n";
}

void print(const std::string& name, const Row& row) {
  std::cout << '|' << name << " | " << row[0].unknowns << std::fixed << std::setprecision(3);
  std::cout << " | " << row[1].width << ", " << row[2].width << ", " << row[3].width << " |";
  std::cout << std::scientific << std::setprecision(1);
  for (const Result& result : row) std::cout << ' ' << result.error << " |";
  std::cout << std::endl;
}

void print_orders(const Row& coarse, const Row& fine) {
  std::cout << "| | *order* | |" << std::fixed << std::setprecision(2);
  for (std::size_t e = 0; e < fine.size(); ++e) {
    const double finer = coarse[e].width / fine[e].width;
    std::cout << " *" << std::log(coarse[e].error / fine[e].error) / std::log(finer) << "* |";
  }
  std::cout << std::endl;
}

void print_rows(const Surface& surface) {
  Row coarse;
  Row fine;
  for (const int nodes : kNodes) {
    coarse = fine;
    fine = solve_all(surface, nodes);
    print(nodes == kNodes.front() ? " " + surface.name : "", fine);
  }
  print_orders(coarse, fine);
}

}  // namespace

int main() try {
  print_header();
  for (const Surface& surface : all_surfaces()) print_rows(surface);
} catch (const timbre::Error& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
