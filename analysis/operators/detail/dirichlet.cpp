#include "timbre/analysis/operators/detail/dirichlet.h"

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/mesh/sides.h"

namespace timbre::detail {
namespace {

using Eigen::Index;

std::size_t at(Index index) { return static_cast<std::size_t>(index); }

// Labels what hangs together by the entries of the stiffness, and says what it was part of.
std::vector<std::int32_t> relabel(Operator& op) {
  const std::vector<std::int32_t> before = op.component;
  std::vector<std::int32_t> part_of;
  op.component.assign(before.size(), -1);
  std::vector<Index> waiting;
  for (std::size_t v = 0; v < before.size(); ++v) {
    if (before[v] < 0 || op.component[v] >= 0) continue;
    const auto label = static_cast<std::int32_t>(part_of.size());
    part_of.push_back(before[v]);
    op.component[v] = label;
    waiting.push_back(static_cast<Index>(v));
    while (!waiting.empty()) {
      const Index from = waiting.back();
      waiting.pop_back();
      for (SparseMatrix::InnerIterator it(op.stiffness, from); it; ++it) {
        if (op.component[at(it.row())] >= 0) continue;
        op.component[at(it.row())] = label;
        waiting.push_back(it.row());
      }
    }
  }
  return part_of;
}

}  // namespace

std::vector<bool> boundary_vertices(const Faces& faces, Index vertices) {
  std::vector<bool> on_boundary(at(vertices), false);
  const std::vector<TriangleSide> sides = sorted_sides(faces);
  for (std::size_t i = 0; i < sides.size();) {
    const std::size_t end = end_of_edge(sides, i);
    if (end - i == 1) on_boundary[at(sides[i].low)] = on_boundary[at(sides[i].high)] = true;
    i = end;
  }
  return on_boundary;
}

void fix_rows(Operator& op, const std::vector<bool>& fixed) {
  const auto is_free = [&](Index row, Index column, double) {
    return !fixed[at(row)] && !fixed[at(column)];
  };
  op.stiffness.prune(is_free);
  op.mass.prune(is_free);
  std::vector<bool> touched(op.has_constants.size(), false);
  for (std::size_t row = 0; row < fixed.size(); ++row) {
    if (!fixed[row] || op.component[row] < 0) continue;
    touched[at(op.component[row])] = true;
    op.lumped_mass[static_cast<Index>(row)] = 0.0;
    op.component[row] = -1;
  }
  const std::vector<std::int32_t> part_of = relabel(op);
  if (part_of.empty()) {
    throw Error(ErrorKind::bad_request, "", "boundary",
                "all vertices lie on it; with Dirichlet conditions nothing is left");
  }
  op.has_constants.clear();
  for (const std::int32_t component : part_of) op.has_constants.push_back(!touched[at(component)]);
  op.component_area = Eigen::VectorXd::Zero(static_cast<Index>(part_of.size()));
  for (std::size_t row = 0; row < op.component.size(); ++row) {
    if (op.component[row] < 0) continue;
    op.component_area[op.component[row]] += op.lumped_mass[static_cast<Index>(row)];
  }
}

}  // namespace timbre::detail
