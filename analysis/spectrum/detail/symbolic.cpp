#include "timbre/analysis/spectrum/detail/symbolic.h"

#include <algorithm>
#include <string>
#include <utility>

#include "timbre/analysis/core/error.h"

namespace timbre::detail {
namespace {

void require_permutation(const std::vector<int>& order, int n) {
  std::vector<bool> seen(static_cast<std::size_t>(n), false);
  bool good = std::ssize(order) == n;
  for (std::size_t i = 0; good && i < order.size(); ++i) {
    good = order[i] >= 0 && order[i] < n && !seen[order[i]];
    if (good) seen[order[i]] = true;
  }
  if (good) return;
  throw Error(ErrorKind::bad_request, "", "ordering",
              "is no permutation of the " + std::to_string(n) + " unknowns");
}

// The tree with its columns renumbered: what was post[i] is now i.
std::vector<int> renumbered(const std::vector<int>& parent, const std::vector<int>& post) {
  std::vector<int> place(post.size());
  for (std::size_t i = 0; i < post.size(); ++i) place[post[i]] = static_cast<int>(i);
  std::vector<int> out(post.size());
  for (std::size_t i = 0; i < post.size(); ++i) {
    const int p = parent[post[i]];
    out[i] = p == -1 ? -1 : place[p];
  }
  return out;
}

// Columns [begin, end) with `below` rows below them, `zeros` of the entries explicit.
struct Supernode {
  int begin, end, below;
  double zeros;
  [[nodiscard]] int columns() const { return end - begin; }
};

// Column j continues the supernode of j - 1 if it has the same rows, and no other child.
std::vector<Supernode> fundamental(const std::vector<int>& parent, const std::vector<int>& count) {
  std::vector<int> children(parent.size(), 0);
  for (const int p : parent) {
    if (p != -1) ++children[p];
  }
  std::vector<Supernode> nodes;
  for (int j = 0; j < std::ssize(parent); ++j) {
    const bool continues =
        j > 0 && parent[j - 1] == j && count[j] == count[j - 1] - 1 && children[j] == 1;
    if (continues) {
      nodes.back().end = j + 1;
      nodes.back().below = count[j] - 1;
    } else {
      nodes.push_back({j, j + 1, count[j] - 1, 0.0});
    }
  }
  return nodes;
}

// Larger supernodes save index work and run faster; explicit zeros cost memory and work. The
// shares were found by measuring surface meshes.
bool worth_merging(int columns, double share_of_zeros) {
  if (columns <= 8) return true;
  if (columns <= 24) return share_of_zeros < 0.5;
  if (columns <= 64) return share_of_zeros < 0.2;
  return share_of_zeros < 0.06;
}

// Merges supernodes into the parent that follows them.
std::vector<Supernode> relaxed(const std::vector<Supernode>& nodes,
                               const std::vector<int>& parent) {
  std::vector<Supernode> merged;
  for (Supernode node : nodes) {
    while (!merged.empty()) {
      const Supernode& child = merged.back();
      const int above = parent[child.end - 1];
      if (above < node.begin || above >= node.end) break;
      const double c = child.columns();
      const double p = node.columns();
      const double zeros = child.zeros + node.zeros + c * (p + node.below - child.below);
      const double total = (c + p) * (c + p + 1) / 2 + (c + p) * node.below;
      if (!worth_merging(child.columns() + node.columns(), zeros / total)) break;
      node.begin = child.begin;
      node.zeros = zeros;
      merged.pop_back();
    }
    merged.push_back(node);
  }
  return merged;
}

// Rows of a front: those of its own columns, and those of its children.
class RowStructure {
 public:
  RowStructure(const Pencil& pencil, SymbolicFactor& symbolic)
      : pencil_(pencil),
        out_(symbolic),
        supernode_of_(static_cast<std::size_t>(pencil.size)),
        mark_(supernode_of_.size(), -1),
        first_child_(symbolic.first_column.size(), -1),
        next_sibling_(first_child_.size(), -1) {}

  void find() {
    const int count = static_cast<int>(std::ssize(out_.first_column)) - 1;
    for (int s = 0; s < count; ++s) {
      for (int j = out_.first_column[s]; j < out_.first_column[s + 1]; ++j) supernode_of_[j] = s;
    }
    out_.parent.assign(static_cast<std::size_t>(count), -1);
    out_.first_row.assign(static_cast<std::size_t>(count) + 1, 0);
    for (int s = 0; s < count; ++s) find(s);
  }

 private:
  void find(int s) {
    const int end = out_.first_column[s + 1];
    const auto begin_rows = std::ssize(out_.rows);
    const auto add = [&](int i) {
      if (i < end || mark_[i] == s) return;
      mark_[i] = s;
      out_.rows.push_back(i);
    };
    for (std::int64_t e = pencil_.start[out_.first_column[s]]; e < pencil_.start[end]; ++e) {
      add(pencil_.row[e]);
    }
    for (int c = first_child_[s]; c != -1; c = next_sibling_[c]) {
      for (std::int64_t e = out_.first_row[c]; e < out_.first_row[c + 1]; ++e) add(out_.rows[e]);
    }
    std::sort(out_.rows.begin() + begin_rows, out_.rows.end());
    out_.first_row[s + 1] = std::ssize(out_.rows);
    if (out_.rows_below(s) == 0) return;
    const int p = supernode_of_[out_.rows[begin_rows]];
    out_.parent[s] = p;
    next_sibling_[s] = first_child_[p];
    first_child_[p] = s;
  }

  const Pencil& pencil_;
  SymbolicFactor& out_;
  std::vector<int> supernode_of_, mark_, first_child_, next_sibling_;
};

// Both lists ascend: one walk through the parent's rows for each child.
void find_places(SymbolicFactor& symbolic) {
  symbolic.place.resize(symbolic.rows.size());
  for (int s = 0; s < symbolic.supernodes(); ++s) {
    const int p = symbolic.parent[s];
    if (p == -1) continue;
    const int begin = symbolic.first_column[p];
    const int end = symbolic.first_column[p + 1];
    std::int64_t at = symbolic.first_row[p];
    for (std::int64_t e = symbolic.first_row[s]; e < symbolic.first_row[s + 1]; ++e) {
      const int i = symbolic.rows[e];
      if (i < end) {
        symbolic.place[e] = i - begin;
        continue;
      }
      while (symbolic.rows[at] < i) ++at;
      symbolic.place[e] = end - begin + static_cast<int>(at - symbolic.first_row[p]);
    }
  }
}

void count_work(SymbolicFactor& symbolic) {
  for (int s = 0; s < symbolic.supernodes(); ++s) {
    const std::int64_t c = symbolic.columns(s);
    const std::int64_t r = symbolic.rows_below(s);
    symbolic.entries += c * (c + 1) / 2 + c * r;
    for (std::int64_t front = r + 1; front <= r + c; ++front) {
      symbolic.flops += static_cast<double>(front * front);
    }
  }
}

}  // namespace

SymbolicFactor analyse(const Pencil& pencil, const std::vector<int>& order) {
  require_permutation(order, pencil.size);
  SymbolicFactor symbolic;
  symbolic.size = pencil.size;
  const std::vector<int> tree = elimination_tree(permuted(pencil, order));
  const std::vector<int> post = postorder(tree);
  const std::vector<int> parent = renumbered(tree, post);
  symbolic.order.reserve(order.size());
  for (const int i : post) symbolic.order.push_back(order[i]);
  const Pencil ordered = permuted(pencil, symbolic.order);
  for (const Supernode& node :
       relaxed(fundamental(parent, column_counts(ordered, parent)), parent)) {
    symbolic.first_column.push_back(node.begin);
  }
  symbolic.first_column.push_back(pencil.size);
  RowStructure(ordered, symbolic).find();
  find_places(symbolic);
  count_work(symbolic);
  return symbolic;
}

}  // namespace timbre::detail
