#include "timbre/analysis/spectrum/detail/traversal.h"

#include <algorithm>
#include <queue>
#include <utility>

#include "timbre/analysis/spectrum/detail/front.h"

namespace timbre::detail {
namespace {

void list_children(const SymbolicFactor& symbolic, Traversal& plan) {
  const auto count = symbolic.parent.size();
  plan.first_child.assign(count + 1, 0);
  for (const int p : symbolic.parent) {
    if (p != -1) ++plan.first_child[p + 1];
  }
  for (std::size_t s = 0; s < count; ++s) plan.first_child[s + 1] += plan.first_child[s];
  plan.children.resize(static_cast<std::size_t>(plan.first_child.back()));
  std::vector<int> next(plan.first_child.begin(), plan.first_child.end() - 1);
  for (std::size_t s = 0; s < count; ++s) {
    const int p = symbolic.parent[s];
    if (p != -1) plan.children[next[p]++] = static_cast<int>(s);
  }
}

// Work of each supernode with all below it. The constant stands for what small fronts cost.
std::vector<double> subtree_work(const SymbolicFactor& symbolic) {
  std::vector<double> work(symbolic.parent.size());
  for (int s = 0; s < symbolic.supernodes(); ++s) {
    const double c = symbolic.columns(s);
    const double r = symbolic.rows_below(s);
    work[s] += 5000.0 + c * (c * c / 3.0 + c * r + r * r);
    if (symbolic.parent[s] != -1) work[symbolic.parent[s]] += work[s];
  }
  return work;
}

// Splits the largest subtree until none holds more than its share of the work.
std::vector<int> subtree_roots(const SymbolicFactor& symbolic, const Traversal& plan, int threads) {
  const std::vector<double> work = subtree_work(symbolic);
  std::priority_queue<std::pair<double, int>> queue;
  double total = 0.0;
  for (int s = 0; s < symbolic.supernodes(); ++s) {
    if (symbolic.parent[s] != -1) continue;
    queue.emplace(work[s], s);
    total += work[s];
  }
  while (!queue.empty() && queue.top().first > total / (8.0 * threads)) {
    const int s = queue.top().second;
    queue.pop();
    for (const int c : plan.children_of(s)) queue.emplace(work[c], c);
  }
  std::vector<int> roots;  // the largest first: then threads end at about the same time
  for (; !queue.empty(); queue.pop()) roots.push_back(queue.top().second);
  return roots;
}

// Update matrices live in two stacks, one from each end of an arena: those of even depth and
// those of odd depth. When a front is assembled its children are on top of one, and its own
// matrix goes to the other.
class Arena {
 public:
  Arena(const SymbolicFactor& symbolic, const std::vector<int>& depth, Traversal& plan)
      : symbolic_(symbolic), depth_(depth), plan_(plan) {}

  void run(Sequence& sequence, int name) {
    std::int64_t used[2] = {0, 0};
    for (const int s : sequence.supernodes) {
      const int side = depth_[s] % 2;
      plan_.place[s] = used[side];
      used[side] += update_size(symbolic_, s);
      sequence.values = std::max(sequence.values, used[0] + used[1]);
      for (const int c : plan_.children_of(s)) {
        if (plan_.sequence_of[c] == name) used[1 - side] -= update_size(symbolic_, c);
      }
    }
    for (const int s : sequence.supernodes) {  // the odd stack grows down from the end
      if (depth_[s] % 2 == 0) continue;
      plan_.place[s] = sequence.values - plan_.place[s] - update_size(symbolic_, s);
    }
  }

 private:
  const SymbolicFactor& symbolic_;
  const std::vector<int>& depth_;
  Traversal& plan_;
};

std::vector<int> depths(const SymbolicFactor& symbolic) {
  std::vector<int> depth(symbolic.parent.size(), 0);
  for (int s = symbolic.supernodes() - 1; s >= 0; --s) {
    if (symbolic.parent[s] != -1) depth[s] = depth[symbolic.parent[s]] + 1;
  }
  return depth;
}

}  // namespace

Traversal plan_traversal(const SymbolicFactor& symbolic, int threads) {
  Traversal plan;
  list_children(symbolic, plan);
  plan.sequence_of.assign(symbolic.parent.size(), -1);
  plan.place.assign(symbolic.parent.size(), 0);
  if (threads > 1) {
    const std::vector<int> roots = subtree_roots(symbolic, plan, threads);
    plan.subtrees.resize(roots.size());
    for (std::size_t i = 0; i < roots.size(); ++i) plan.sequence_of[roots[i]] = static_cast<int>(i);
  }
  for (int s = symbolic.supernodes() - 1; s >= 0; --s) {
    const int p = symbolic.parent[s];
    if (p != -1 && plan.sequence_of[p] != -1) plan.sequence_of[s] = plan.sequence_of[p];
  }
  for (int s = 0; s < symbolic.supernodes(); ++s) {
    const int q = plan.sequence_of[s];
    (q == -1 ? plan.top : plan.subtrees[q]).supernodes.push_back(s);
  }
  const std::vector<int> depth = depths(symbolic);
  Arena arena(symbolic, depth, plan);
  for (std::size_t i = 0; i < plan.subtrees.size(); ++i) {
    arena.run(plan.subtrees[i], static_cast<int>(i));
  }
  arena.run(plan.top, -1);
  return plan;
}

}  // namespace timbre::detail
