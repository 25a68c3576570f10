#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "timbre/analysis/spectrum/detail/aligned_array.h"
#include "timbre/analysis/spectrum/detail/diagonal_block.h"
#include "timbre/analysis/spectrum/detail/panels.h"
#include "timbre/analysis/spectrum/detail/pencil.h"
#include "timbre/analysis/spectrum/detail/symbolic.h"

namespace timbre::detail {

/// The arrays of one factorisation, shared by the threads that work on it. Each supernode
/// writes to its own part.
struct FactorArrays {
  double* values;       ///< PanelLayout::values
  double* d;            ///< size: diagonal of D^-1
  double* e;            ///< size: beside it
  int* order;           ///< size: inside each panel, see Panel
  PivotCounts* counts;  ///< one for each supernode
};

/// What every front of one factorisation reads.
struct FactorInput {
  const SymbolicFactor& symbolic;
  const PanelLayout& layout;
  const Pencil& pencil;               ///< in factor order
  const std::vector<int>& entry_row;  ///< of each entry of the pencil: its row in the front
  const std::vector<double>& scale;   ///< row_scales
  const TileKernels& kernels;
  double shift;
};

/// Rows of a front are padded between its columns and the rows below, so that tiles of both are
/// aligned.
[[nodiscard]] inline int front_row(int place, int columns) {
  return place < columns ? place : place - columns + padded(columns);
}

/// Doubles of the matrix that a front hands to its parent: padded(rows)^2, column-major.
[[nodiscard]] inline std::int64_t update_size(const SymbolicFactor& symbolic, int s) {
  const std::int64_t side = padded(symbolic.rows_below(s));
  return side * side;
}

/// A child of a front, and the matrix it handed on.
struct Child {
  int supernode;
  const double* update;
};

/// Factorises fronts one at a time, in workspace of its own (the multifrontal method of Duff and
/// Reid 1983).
class FrontFactorizer {
 public:
  explicit FrontFactorizer(const SymbolicFactor& symbolic);

  /// Assembles the columns of front s from the pencil and its children, and factorises them.
  ///
  /// @param children  in the order in which they are to be added
  /// @param update    what s hands on, update_size values; overwritten
  void factorize(const FactorInput& input, int s, std::span<const Child> children, double* update,
                 const FactorArrays& out);

  /// Bytes of workspace for one thread.
  [[nodiscard]] static std::int64_t workspace_bytes(const SymbolicFactor& symbolic);

 private:
  void assemble(const FactorInput& input, int s);
  void add_child(const SymbolicFactor& symbolic, const Child& child, double* update);
  void factorize_panel(const FactorInput& input, const PanelPlace& panel, double* update,
                       const FactorArrays& out);
  void load_below(const PanelPlace& panel, const int* order);
  void divide_by_pivots(const double* d, const double* e);
  void subtract_from_rest(const TileKernels& kernels, double* update);
  void store(double* values) const;

  // The front at hand.
  int first_ = 0, columns_ = 0, rows_ = 0;
  std::int64_t ld_ = 0;
  // The panel at hand: its place in the front, and tiles of rows below it.
  int begin_ = 0, width_ = 0, rest_ = 0, rest_tiles_ = 0, tiles_ = 0, stride_ = 0;

  AlignedArray front_;    // its columns, ld_ apart
  AlignedArray lower_;    // rows below the panel: A21, then L21
  AlignedArray product_;  // L21 D
  AlignedArray block_, work_, inverse_;
};

}  // namespace timbre::detail
