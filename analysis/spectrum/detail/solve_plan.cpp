#include "timbre/analysis/spectrum/detail/solve_plan.h"

#include <algorithm>
#include <queue>
#include <utility>

namespace timbre::detail {
namespace {

constexpr std::int64_t kSmall = std::int64_t{1} << 18U;  // numbers, and below: not worth threads
constexpr std::int64_t kShares = 8;

// Supernodes are in postorder: a subtree is a range that ends with its root.
std::vector<int> first_descendants(const SymbolicFactor& symbolic) {
  std::vector<int> first(symbolic.parent.size());
  for (int s = 0; s < symbolic.supernodes(); ++s) first[s] = s;
  for (int s = 0; s < symbolic.supernodes(); ++s) {
    const int p = symbolic.parent[s];
    if (p != -1) first[p] = std::min(first[p], first[s]);
  }
  return first;
}

// Numbers of the factor that come before each supernode, and those of all.
std::vector<std::int64_t> values_before(const PanelLayout& layout) {
  std::vector<std::int64_t> before;
  before.reserve(layout.first_panel.size());
  for (const int p : layout.first_panel) {
    const bool is_end = p == static_cast<int>(layout.panels.size());
    before.push_back(is_end ? layout.values : layout.panels[p].values);
  }
  return before;
}

}  // namespace

SolvePlan plan_solves(const SymbolicFactor& symbolic, const PanelLayout& layout) {
  const std::vector<int> first = first_descendants(symbolic);
  const std::vector<std::int64_t> before = values_before(layout);
  std::priority_queue<std::pair<std::int64_t, int>> largest;
  const auto push = [&](int s) { largest.emplace(before[s + 1] - before[first[s]], s); };
  SolvePlan plan;
  for (int s = 0; s < symbolic.supernodes(); ++s) {
    if (symbolic.parent[s] == -1) push(s);
  }
  std::vector<bool> is_top(symbolic.parent.size(), false);
  while (!largest.empty() &&
         (layout.values < kSmall || largest.top().first > layout.values / kShares)) {
    const int s = largest.top().second;
    largest.pop();
    is_top[s] = true;
    for (int c = s - 1; c >= first[s]; c = first[c] - 1) push(c);
  }
  for (; !largest.empty(); largest.pop()) plan.root.push_back(largest.top().second);
  std::sort(plan.root.begin(), plan.root.end());
  plan.handed.push_back(0);
  for (const int s : plan.root) {
    plan.first.push_back(first[s]);
    plan.handed.push_back(plan.handed.back() + symbolic.rows_below(s));
  }
  for (int s = 0; s < symbolic.supernodes(); ++s) {
    if (is_top[s]) plan.top.push_back(s);
  }
  return plan;
}

}  // namespace timbre::detail
