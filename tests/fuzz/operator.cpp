// The robust operator of any triangles: finite, symmetric, no negative weight, positive
// semi-definite; or one line.
#include <Eigen/Eigenvalues>
#include <bit>
#include <cmath>

#include "timbre/analysis/operators/operator.h"
#include "timbre/tests/fuzz/target.h"

namespace timbre::fuzz {
namespace {

using Eigen::MatrixXd;

constexpr std::size_t kMostVertices = 40;
constexpr Eigen::Index kMostFaces = 80;

// On a small lattice, where points coincide and lie on lines, or of any bits.
double coordinate(Draw& draw, bool wild) {
  if (!wild) return draw.take<std::int8_t>() / 32;
  const auto value = draw.take<double>();
  return std::isfinite(value) ? value : 1.0;
}

TriangleMesh drawn_mesh(Draw& draw) {
  const bool wild = draw.below(4) == 0;
  TriangleMesh mesh;
  mesh.vertices.resize(static_cast<Eigen::Index>(3 + draw.below(kMostVertices - 2)), 3);
  for (double& x : mesh.vertices.reshaped<Eigen::RowMajor>()) x = coordinate(draw, wild);
  mesh.faces.resize(kMostFaces, 3);
  Eigen::Index count = 0;
  for (; count < kMostFaces && !draw.empty(); ++count) {
    for (std::int32_t& corner : mesh.faces.row(count)) {
      corner =
          static_cast<std::int32_t>(draw.below(static_cast<std::size_t>(mesh.vertices.rows())));
    }
  }
  mesh.faces.conservativeResize(count, 3);
  return mesh;
}

void require_sound(const Operator& op) {
  const MatrixXd W = op.stiffness;
  require(W.allFinite() && op.lumped_mass.allFinite(), "numbers are finite");
  require(W == W.transpose(), "W is symmetric to the bit");
  require(op.lumped_mass.minCoeff() >= 0.0, "no mass is negative");
  for (Eigen::Index v = 0; v < W.rows(); ++v) {
    const bool takes_part = op.component[static_cast<std::size_t>(v)] >= 0;
    require(takes_part == (op.lumped_mass[v] > 0.0), "a row with a part has mass");
    for (Eigen::Index u = 0; u < v; ++u) require(W(u, v) <= 0.0, "no weight is negative");
  }
  const Eigen::SelfAdjointEigenSolver<MatrixXd> dense(W, Eigen::EigenvaluesOnly);
  require(dense.eigenvalues()[0] >= -1e-11 * W.cwiseAbs().maxCoeff(), "W is semi-definite");
}

}  // namespace

void examine(std::string_view input) {
  Draw draw(input);
  const TriangleMesh mesh = drawn_mesh(draw);
  try {
    require_sound(compute_operator(mesh));
  } catch (const Error& error) {
    require_plain(error, ErrorKind::bad_input);
  }
}

}  // namespace timbre::fuzz
