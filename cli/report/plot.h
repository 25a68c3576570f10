#pragma once

#include <string>
#include <utility>
#include <vector>

namespace timbre::cli {

/// Curves that share a colour and a label at their right end.
struct PlotSeries {
  std::string label;  ///< empty: none is written
  int style = 0;      ///< which of the page's colours, then dashes: 0, 1, ...
  bool is_bold = false;
  std::vector<std::vector<std::pair<double, double>>> curves = {};
};

struct PlotAxis {
  std::string title;
  double low = 0.0, high = 1.0;
  std::vector<std::pair<double, std::string>> ticks;
  bool is_logarithmic = false;
};

struct Plot {
  std::string about;  ///< what it shows, for those who do not see it
  PlotAxis x, y;
  std::vector<PlotSeries> series;
  double height = 440.0;  ///< of a drawing 960 wide
};

/// Curves with axes as an inline SVG that takes its colours from the page. Labels stand at the
/// ends of their curves, as near as they can without touching each other.
[[nodiscard]] std::string to_svg(const Plot& plot);

}  // namespace timbre::cli
