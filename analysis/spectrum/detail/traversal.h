#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "timbre/analysis/spectrum/detail/symbolic.h"

namespace timbre::detail {

/// Supernodes that one thread factorises, children first, and the memory for what they hand on.
struct Sequence {
  std::vector<int> supernodes;
  std::int64_t values = 0;  ///< doubles of its arena
};

/// In which order, and on how many threads, the tree of supernodes is walked. Subtrees are
/// independent of each other; `top` needs all of them. Every front is computed the same way
/// wherever it is, so the factor does not depend on the threads.
struct Traversal {
  std::vector<Sequence> subtrees;
  Sequence top;
  std::vector<int> sequence_of;     ///< of each supernode: its subtree, or -1 for the top
  std::vector<std::int64_t> place;  ///< of each supernode's update matrix in its arena
  std::vector<int> first_child;     ///< supernodes + 1
  std::vector<int> children;        ///< of s: [first_child[s], first_child[s + 1]), ascending

  [[nodiscard]] std::span<const int> children_of(int s) const {
    return std::span(children).subspan(
        static_cast<std::size_t>(first_child[s]),
        static_cast<std::size_t>(first_child[s + 1] - first_child[s]));
  }
};

/// @param threads  with 1 there are no subtrees
[[nodiscard]] Traversal plan_traversal(const SymbolicFactor& symbolic, int threads);

}  // namespace timbre::detail
