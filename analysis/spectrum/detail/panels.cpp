#include "timbre/analysis/spectrum/detail/panels.h"

#include <algorithm>

namespace timbre::detail {

std::int64_t PanelLayout::inverse_values(int width) {
  std::int64_t values = 0;
  for (int row = 0; row < width; row += kTile) {
    const int height = std::min(kTile, width - row);
    values += static_cast<std::int64_t>(height) * (row + height);
  }
  return values;
}

PanelLayout lay_out_panels(const SymbolicFactor& symbolic) {
  PanelLayout layout;
  layout.first_panel.push_back(0);
  for (int s = 0; s < symbolic.supernodes(); ++s) {
    const int columns = symbolic.columns(s);
    const int parts = (columns + kPanelWidth - 1) / kPanelWidth;
    const int width = padded((columns + parts - 1) / parts);
    for (int done = 0; done < columns; done += width) {
      PanelPlace panel{symbolic.first_column[s] + done, std::min(width, columns - done),
                       layout.values};
      const std::int64_t below = columns - done - panel.width + symbolic.rows_below(s);
      layout.values += PanelLayout::inverse_values(panel.width) + below * panel.width;
      layout.panels.push_back(panel);
    }
    layout.first_panel.push_back(static_cast<int>(layout.panels.size()));
  }
  return layout;
}

}  // namespace timbre::detail
