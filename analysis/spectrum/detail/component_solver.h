#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "timbre/analysis/operators/operator.h"

namespace timbre::detail {

/// One connected component of a mesh, scaled to unit area, and the eigenpairs found
/// so far. It has one zero eigenvalue, of the constant function, or with a Dirichlet boundary none.
struct Component {
  std::vector<std::int32_t> vertices;  ///< rows of the whole mesh
  SparseMatrix stiffness;
  SparseMatrix mass;
  Eigen::VectorXd lumped_mass;
  Points positions;   ///< of the rows, or empty
  double area = 0.0;  ///< true area; eigenvalues here are `area` times the true ones
  bool diagonal_mass = true;
  bool has_constants = true;

  Eigen::VectorXd values;   ///< ascending, the lowest of the component
  Eigen::MatrixXd vectors;  ///< M-orthonormal

  [[nodiscard]] Eigen::Index size() const { return stiffness.rows(); }
  [[nodiscard]] bool exhausted() const { return values.size() == size(); }
};

[[nodiscard]] std::vector<Component> split_into_components(const Operator& op);

struct ComponentSolveOptions {
  int attempt = 0;                    ///< another start for each
  std::function<void(int)> on_solve;  ///< after so many solves with a factor; may throw
};

/// Replaces the pairs by the lowest `count` (capped at n), or some more. Dense for a small
/// component or a large share of its pairs, else band by band.
/// @throws Error  not_converged
void solve_lowest(Component& component, Eigen::Index count, const ComponentSolveOptions& options);

/// Relative residual of each pair, in the norm of the inverse lumped mass.
[[nodiscard]] Eigen::VectorXd relative_residuals(const Component& component);

}  // namespace timbre::detail
