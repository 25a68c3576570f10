#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "timbre/analysis/core/progress.h"
#include "timbre/analysis/operators/operator.h"

namespace timbre {

struct FiedlerOrder {
  /// All vertices: component after component, each along its Fiedler vector; equal values and
  /// vertices without part, which come last, by number.
  std::vector<std::int32_t> order;
  Eigen::VectorXd vector;  ///< n, of each component its own, of norm 1 there; 0 without part
  Eigen::VectorXd values;  ///< one per component, lambda_1, 1/length^2
  /// One per component, `relative_gap` from lambda_1 to lambda_2. Near 0 (a sphere, a square) the
  /// vector is any one of an eigenspace, and the order one of many as good.
  Eigen::VectorXd gaps;
};

/// Orders vertices along each component's Fiedler vector, the eigenfunction of lambda_1: the
/// embedding on a line that keeps neighbours together best. Each component is solved alone, so
/// that small ones beside large ones have their own. Of the two directions that one is taken which
/// starts at the smaller vertex number; the solver's sign does not matter.
///
/// @param threads  that solve a component, if it is large; 0: all cores
/// @throws Error  bad_request for a Dirichlet boundary, under which the lowest eigenfunction is no
///                constant; not_converged; cancelled
/// @see Fiedler 1975; Isenburg and Lindstrom 2005; Levy and Zhang 2009, equation 12
[[nodiscard]] FiedlerOrder compute_fiedler_order(const Operator& op, const Progress& progress = {},
                                                 int threads = 0);

}  // namespace timbre
