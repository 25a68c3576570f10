#pragma once

#include <vector>

#include "timbre/analysis/operators/operator.h"

namespace timbre::detail {

/// The vertices of edges of one triangle only.
[[nodiscard]] std::vector<bool> boundary_vertices(const Faces& faces, Eigen::Index vertices);

/// Takes these rows out of the eigenvalue problem: functions are 0 there. What is left of a
/// component may fall into several.
/// @param fixed  one for each row
/// @throws Error  bad_request if nothing is left
void fix_rows(Operator& op, const std::vector<bool>& fixed);

}  // namespace timbre::detail
