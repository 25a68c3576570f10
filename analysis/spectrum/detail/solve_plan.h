#pragma once

#include <vector>

#include "timbre/analysis/spectrum/detail/panels.h"
#include "timbre/analysis/spectrum/detail/symbolic.h"

namespace timbre::detail {

/// Parts of the elimination tree that a solve can work on at the same time. They depend on the
/// matrix alone, so that sums are made in the same order on any number of threads.
struct SolvePlan {
  std::vector<int> first;  ///< of each subtree: supernodes first[q] ... root[q]
  std::vector<int> root;
  std::vector<int> top;              ///< the other supernodes, ascending
  std::vector<std::int64_t> handed;  ///< subtrees + 1: rows below the roots, in all before each

  [[nodiscard]] int subtrees() const { return static_cast<int>(root.size()); }
};

/// Subtrees of a share of the factor each; none if the factor is small.
[[nodiscard]] SolvePlan plan_solves(const SymbolicFactor& symbolic, const PanelLayout& layout);

}  // namespace timbre::detail
