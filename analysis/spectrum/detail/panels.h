#pragma once

#include <cstdint>
#include <vector>

#include "timbre/analysis/spectrum/detail/symbolic.h"
#include "timbre/analysis/spectrum/detail/tile_kernels.h"

namespace timbre::detail {

/// Where a panel of a supernode is stored. A supernode is cut into panels of kPanelWidth columns
/// or fewer, so that pivoting and the explicit inverses stay local.
struct PanelPlace {
  int column;           ///< the first one
  int width;            ///< columns
  std::int64_t values;  ///< first value in the factor: inverse, then the rows below
};

/// The layout of the factor: known before any number is.
struct PanelLayout {
  std::vector<PanelPlace> panels;
  std::vector<int> first_panel;  ///< of each supernode; supernodes + 1
  std::int64_t values = 0;       ///< doubles in the factor

  /// Doubles that the inverse of a panel's diagonal block takes.
  [[nodiscard]] static std::int64_t inverse_values(int width);
};

[[nodiscard]] PanelLayout lay_out_panels(const SymbolicFactor& symbolic);

}  // namespace timbre::detail
