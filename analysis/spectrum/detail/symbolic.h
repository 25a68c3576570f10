#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "timbre/analysis/spectrum/detail/pencil.h"

namespace timbre::detail {

/// The elimination tree (Liu 1990): the parent of column j is the row of the first entry of L
/// below its diagonal; -1 for a root. Always larger than j.
[[nodiscard]] std::vector<int> elimination_tree(const Pencil& pencil);

/// A postorder of a forest given by parents: children come before their parent, in ascending
/// order, and each subtree is contiguous. `post[i]` is visited as number i.
[[nodiscard]] std::vector<int> postorder(const std::vector<int>& parent);

/// Entries of each column of L, with the diagonal, of a pencil in postorder (Gilbert, Ng and
/// Peyton 1994). Cost: almost linear in the entries of the pencil.
[[nodiscard]] std::vector<int> column_counts(const Pencil& pencil, const std::vector<int>& parent);

/// The part of the factorisation that depends on the pattern alone; valid for every shift.
///
/// Columns with nearly the same rows below them form a supernode (Ashcraft and Grimes 1989 for
/// the merging of small ones). Columns first_column[s] ... first_column[s + 1] - 1 form supernode
/// s; below its diagonal block it has the rows [first_row[s], first_row[s + 1]) of `rows`. These
/// columns and rows are its front; `place` says where each row stands in the parent's front.
struct SymbolicFactor {
  int size = 0;
  std::vector<int> order;               ///< unknown order[i] is eliminated as number i; postordered
  std::vector<int> first_column;        ///< supernodes + 1
  std::vector<int> parent;              ///< of each supernode; -1 for a root
  std::vector<std::int64_t> first_row;  ///< supernodes + 1
  std::vector<int> rows;                ///< ascending in each supernode
  std::vector<int> place;               ///< of each of `rows` in the front of the parent
  std::int64_t entries = 0;             ///< of L with its diagonal, explicit zeros included
  double flops = 0.0;                   ///< of one factorisation, a multiply-add as two

  [[nodiscard]] int supernodes() const { return static_cast<int>(parent.size()); }
  [[nodiscard]] int columns(int s) const {
    const auto i = static_cast<std::size_t>(s);
    return first_column[i + 1] - first_column[i];
  }
  [[nodiscard]] int rows_below(int s) const {
    const auto i = static_cast<std::size_t>(s);
    return static_cast<int>(first_row[i + 1] - first_row[i]);
  }
};

/// Analyses a pencil under an ordering.
///
/// @param pencil  in the caller's order
/// @param order   a permutation: unknown order[i] comes as number i; made a postorder inside
/// @throws Error  bad_request if `order` is no permutation of the unknowns
[[nodiscard]] SymbolicFactor analyse(const Pencil& pencil, const std::vector<int>& order);

}  // namespace timbre::detail
