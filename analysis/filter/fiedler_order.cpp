#include "timbre/analysis/filter/fiedler_order.h"

#include <algorithm>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/filter/spectral_gap.h"
#include "timbre/analysis/operators/components.h"
#include "timbre/analysis/spectrum/spectrum.h"

namespace timbre {
namespace {

using Eigen::Index;
using Rows = std::vector<std::int32_t>;

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

// The operator of one component alone.
Operator part_of(const Operator& op, std::size_t component, const Rows& rows, const Rows& place) {
  Operator part;
  part.stiffness = restricted(op.stiffness, rows, place);
  part.mass = restricted(op.mass, rows, place);
  part.lumped_mass = op.lumped_mass(rows);
  if (op.positions.rows() > 0) part.positions = op.positions(rows, Eigen::all);
  part.component.assign(rows.size(), 0);
  part.area = op.component_area[static_cast<Index>(component)];
  part.component_area = Eigen::VectorXd::Constant(1, part.area);
  part.has_constants = {op.has_constants[component]};
  part.vertices = static_cast<Index>(rows.size());
  part.kind = op.kind;
  part.mass_kind = op.mass_kind;
  return part;
}

// Values along the rows, in the direction that starts at the smaller vertex number.
Eigen::VectorXd directed(Eigen::VectorXd along) {
  Index first = 0;
  Index last = 0;
  along.minCoeff(&first);
  along.maxCoeff(&last);
  if (last < first) along = -along;
  return along;
}

}  // namespace

FiedlerOrder compute_fiedler_order(const Operator& op, const Progress& progress, int threads) {
  if (op.boundary == BoundaryKind::dirichlet) {
    throw Error(ErrorKind::bad_request, "", "boundary",
                "the Fiedler vector is one of the neumann boundary");
  }
  const auto [rows, place] = rows_of_components(op);
  FiedlerOrder found;
  found.vector = Eigen::VectorXd::Zero(op.vertices);
  found.values.resize(op.component_area.size());
  found.gaps.resize(op.component_area.size());
  for (std::size_t c = 0; c < rows.size(); ++c) {
    const Spectrum spectrum = compute_spectrum(
        part_of(op, c, rows[c], place), {.count = 3, .threads = threads, .progress = progress});
    const auto component = static_cast<Index>(c);
    found.values[component] = spectrum.values[1];
    found.gaps[component] = relative_gap(spectrum.values, 1);

    // Nodes of higher elements follow all vertices, in each component too.
    const Index vertices =
        std::lower_bound(rows[c].begin(), rows[c].end(), op.vertices) - rows[c].begin();
    const Eigen::VectorXd along = directed(spectrum.vectors.col(1).head(vertices));
    const std::size_t begin = found.order.size();
    for (Index i = 0; i < vertices; ++i) {
      found.order.push_back(rows[c][static_cast<std::size_t>(i)]);
      found.vector[found.order.back()] = along[i];
    }
    std::stable_sort(
        found.order.begin() + static_cast<std::ptrdiff_t>(begin), found.order.end(),
        [&](std::int32_t a, std::int32_t b) { return found.vector[a] < found.vector[b]; });
  }
  for (std::int32_t v = 0; v < op.vertices; ++v) {
    if (op.component[at(v)] < 0) found.order.push_back(v);
  }
  return found;
}

}  // namespace timbre
