#include <numeric>
#include <utility>

#include "timbre/analysis/spectrum/detail/symbolic.h"

namespace timbre::detail {
namespace {

// The lower triangle by rows: columns of row i below its diagonal, ascending.
struct Rows {
  std::vector<std::int64_t> start;
  std::vector<int> column;
};

Rows by_rows(const Pencil& pencil) {
  Rows rows;
  rows.start.assign(static_cast<std::size_t>(pencil.size) + 1, 0);
  for (const int i : pencil.row) ++rows.start[i + 1];
  for (int i = 0; i < pencil.size; ++i) rows.start[i + 1] += rows.start[i] - 1;  // no diagonal
  rows.column.resize(static_cast<std::size_t>(rows.start.back()));
  std::vector<std::int64_t> next(rows.start.begin(), rows.start.end() - 1);
  for (int j = 0; j < pencil.size; ++j) {
    for (std::int64_t e = pencil.start[j] + 1; e < pencil.start[j + 1]; ++e) {
      rows.column[next[pencil.row[e]]++] = j;
    }
  }
  return rows;
}

// Counts leaves of row subtrees as Davis (2006, section 4.4) does: each leaf adds one to the
// path from it up to the least common ancestor with the leaf before.
class LeafCounter {
 public:
  explicit LeafCounter(const std::vector<int>& parent)
      : parent_(parent),
        ancestor_(parent.size()),
        first_(parent.size(), -1),
        last_first_(parent.size(), -1),
        last_leaf_(parent.size(), -1),
        delta_(parent.size(), 0) {
    std::iota(ancestor_.begin(), ancestor_.end(), 0);
    for (int j = 0; j < size(); ++j) {
      delta_[j] = first_[j] == -1 ? 1 : 0;  // a leaf of the tree counts itself
      for (int a = j; a != -1 && first_[a] == -1; a = parent_[a]) first_[a] = j;
    }
  }

  // Column j reaches row i, j < i.
  void visit(int i, int j) {
    if (first_[j] <= last_first_[i]) return;  // not a leaf of the subtree of row i
    last_first_[i] = first_[j];
    const int before = last_leaf_[i];
    last_leaf_[i] = j;
    ++delta_[j];
    if (before != -1) --delta_[root_of(before)];
  }

  void finish_column(int j) {
    if (parent_[j] == -1) return;
    --delta_[parent_[j]];  // what counts row j itself ends here
    ancestor_[j] = parent_[j];
  }

  std::vector<int> sums() && {
    for (int j = 0; j < size(); ++j) {
      if (parent_[j] != -1) delta_[parent_[j]] += delta_[j];
    }
    return std::move(delta_);
  }

 private:
  [[nodiscard]] int size() const { return static_cast<int>(parent_.size()); }

  int root_of(int j) {
    int root = j;
    while (ancestor_[root] != root) root = ancestor_[root];
    while (ancestor_[j] != root) {
      const int next = ancestor_[j];
      ancestor_[j] = root;
      j = next;
    }
    return root;
  }

  const std::vector<int>& parent_;
  std::vector<int> ancestor_, first_, last_first_, last_leaf_, delta_;
};

}  // namespace

std::vector<int> elimination_tree(const Pencil& pencil) {
  const Rows rows = by_rows(pencil);
  std::vector<int> parent(static_cast<std::size_t>(pencil.size), -1);
  std::vector<int> ancestor(parent.size(), -1);  // shortcuts up the tree built so far
  for (int i = 0; i < pencil.size; ++i) {
    for (std::int64_t e = rows.start[i]; e < rows.start[i + 1]; ++e) {
      for (int j = rows.column[e]; j != -1 && j < i;) {
        const int next = ancestor[j];
        ancestor[j] = i;
        if (next == -1) parent[j] = i;
        j = next;
      }
    }
  }
  return parent;
}

std::vector<int> postorder(const std::vector<int>& parent) {
  const int n = static_cast<int>(parent.size());
  std::vector<int> first_child(parent.size(), -1);
  std::vector<int> next_sibling(parent.size(), -1);
  for (int j = n - 1; j >= 0; --j) {
    if (parent[j] == -1) continue;
    next_sibling[j] = first_child[parent[j]];
    first_child[parent[j]] = j;
  }
  std::vector<int> post;
  post.reserve(parent.size());
  std::vector<int> path;
  for (int root = 0; root < n; ++root) {
    if (parent[root] != -1) continue;
    path.push_back(root);
    while (!path.empty()) {
      const int j = path.back();
      if (first_child[j] != -1) {
        path.push_back(first_child[j]);
        first_child[j] = next_sibling[first_child[j]];
      } else {
        post.push_back(j);
        path.pop_back();
      }
    }
  }
  return post;
}

std::vector<int> column_counts(const Pencil& pencil, const std::vector<int>& parent) {
  LeafCounter counter(parent);
  for (int j = 0; j < pencil.size; ++j) {
    for (std::int64_t e = pencil.start[j] + 1; e < pencil.start[j + 1]; ++e) {
      counter.visit(pencil.row[e], j);
    }
    counter.finish_column(j);
  }
  return std::move(counter).sums();
}

}  // namespace timbre::detail
