// What the pictures of docs/operators.md are drawn from: course_figures MESH FOLDER.
#include <array>
#include <cstdint>
#include <iostream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "timbre/analysis/core/array_file.h"
#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/output_file.h"
#include "timbre/analysis/mesh/read_mesh.h"
#include "timbre/analysis/mesh/write_mesh.h"
#include "timbre/analysis/operators/finite_elements.h"
#include "timbre/analysis/operators/operator.h"
#include "timbre/analysis/spectrum/spectrum.h"

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using timbre::OperatorKind;
using Triangle = std::array<std::int32_t, 3>;

constexpr int kLowest = 40;      // eigenvectors kept by the low-pass filters
constexpr int kFunction = 24;    // eigenfunction drawn by linear and cubic elements
constexpr int kCubicPieces = 6;  // per side of a triangle, to draw a cubic function

// Splits edges that have an end at x > 0, each at its middle: the triangles there in four, those
// beside them in two or three, so that no vertex lies within an edge.
class HalfRefiner {
 public:
  explicit HalfRefiner(const timbre::TriangleMesh& mesh) : mesh_(mesh) {
    for (const auto& row : mesh.vertices.rowwise()) points_.emplace_back(row);
    for (const auto& face : mesh.faces.rowwise()) split({face[0], face[1], face[2]});
  }

  [[nodiscard]] timbre::TriangleMesh refined() const {
    timbre::TriangleMesh result;
    result.vertices.resize(static_cast<Index>(points_.size()), 3);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      result.vertices.row(static_cast<Index>(i)) = points_[i];
    }
    result.faces.resize(static_cast<Index>(triangles_.size()), 3);
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        result.faces(static_cast<Index>(i), static_cast<Index>(c)) = triangles_[i][c];
      }
    }
    return result;
  }

 private:
  // The vertex in the middle of an edge; -1 if the edge stays whole.
  std::int32_t middle(std::int32_t a, std::int32_t b) {
    if (mesh_.vertices(a, 0) <= 0.0 && mesh_.vertices(b, 0) <= 0.0) return -1;
    const auto [place, is_new] =
        middles_.try_emplace(std::minmax({a, b}), static_cast<std::int32_t>(points_.size()));
    if (is_new) points_.emplace_back(0.5 * (mesh_.vertices.row(a) + mesh_.vertices.row(b)));
    return place->second;
  }

  void split(Triangle t) {
    // With one end at x > 0 the edge between the others stays whole: turned to be that from t[2] to
    // t[0]. With two or three ends there all edges are split, with none none.
    while (mesh_.vertices(t[1], 0) <= 0.0 &&
           (mesh_.vertices(t[0], 0) > 0.0 || mesh_.vertices(t[2], 0) > 0.0)) {
      t = {t[1], t[2], t[0]};
    }
    const std::int32_t first = middle(t[0], t[1]);
    const std::int32_t second = middle(t[1], t[2]);
    const std::int32_t third = middle(t[2], t[0]);
    if (first < 0) {
      triangles_.push_back(t);
    } else if (third < 0) {
      triangles_.push_back({first, t[1], second});
      triangles_.push_back({t[0], first, second});
      triangles_.push_back({t[0], second, t[2]});
    } else {
      triangles_.push_back({t[0], first, third});
      triangles_.push_back({first, t[1], second});
      triangles_.push_back({third, second, t[2]});
      triangles_.push_back({first, second, third});
    }
  }

  const timbre::TriangleMesh& mesh_;
  std::vector<Eigen::RowVector3d> points_;
  std::vector<Triangle> triangles_;
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles_;
};

// sum of <x, phi_i> phi_i over the lowest eigenvectors, in the inner product that they are
// orthonormal in; `plain`: of vectors normalised in the plain one, which they are not.
timbre::TriangleMesh low_pass(const timbre::TriangleMesh& mesh, OperatorKind kind, bool plain) {
  const timbre::Operator op = timbre::compute_operator(mesh, {.kind = kind});
  MatrixXd basis = timbre::compute_spectrum(op, {.count = kLowest}).vectors;
  if (plain) basis.colwise().normalize();
  const MatrixXd dual = plain ? basis : MatrixXd(op.mass * basis);
  return {basis * (dual.transpose() * mesh.vertices), mesh.faces};
}

// Figure 16: one eigenfunction by elements of a degree, on triangles small enough to draw it.
void write_elements(const timbre::TriangleMesh& mesh, OperatorKind kind, int degree, int pieces,
                    const std::string& path) {
  const timbre::Operator op =
      timbre::compute_operator(mesh, {.kind = kind, .mass = timbre::MassKind::consistent});
  const timbre::Spectrum found = timbre::compute_spectrum(op, {.count = kFunction + 1});
  const timbre::LagrangeNodes nodes = timbre::number_nodes(mesh.faces, op.vertices, degree);
  const timbre::SampledFunction sampled =
      timbre::sample_function(nodes, mesh.vertices, found.vectors.col(kFunction), pieces);
  timbre::write_mesh(sampled.mesh, path + ".ply", true);
  timbre::write_file(path + ".npy", timbre::to_npy(sampled.values), true);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 3) return 2;
  const timbre::TriangleMesh mesh = timbre::read_mesh(argv[1]).mesh;
  const std::string folder = std::string(argv[2]) + "/";

  write_elements(mesh, OperatorKind::cotan, 1, 1, folder + "linear");
  write_elements(mesh, OperatorKind::p3, 3, kCubicPieces, folder + "cubic");

  const timbre::TriangleMesh uneven = HalfRefiner(mesh).refined();
  timbre::write_mesh(uneven, folder + "uneven.ply", true);
  const auto filter = [&](OperatorKind kind, bool plain, const std::string& name) {
    timbre::write_mesh(low_pass(uneven, kind, plain), folder + name + ".ply", true);
  };
  filter(OperatorKind::graph, false, "A");
  filter(OperatorKind::unweighted, false, "B");
  filter(OperatorKind::cotan, true, "C");
  filter(OperatorKind::averaged, false, "D");
  filter(OperatorKind::dec, false, "E");
  std::cout << uneven.vertices.rows() << " vertices\n";
} catch (const timbre::Error& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
