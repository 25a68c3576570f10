#include <algorithm>
#include <cmath>
#include <numbers>

#include "timbre/analysis/core/number_text.h"
#include "timbre/cli/report/html.h"
#include "timbre/cli/report/material.h"
#include "timbre/cli/report/plot.h"

namespace timbre::cli {
namespace {

// More curves only cover each other, and make the page large.
constexpr std::size_t kMostCurves = 200;
constexpr std::size_t kMostLabels = 24;

std::vector<std::pair<double, double>> curve_of(const Eigen::VectorXd& eigenvalues) {
  std::vector<std::pair<double, double>> curve;
  for (Eigen::Index i = 1; i < eigenvalues.size(); ++i) {
    const auto number = static_cast<double>(i);
    curve.emplace_back(number, eigenvalues(i) / (4.0 * std::numbers::pi * number));
  }
  return curve;
}

std::vector<ShapeClass> series_of(const Material& material) {
  if (material.has_labels || material.shapes.size() > kMostLabels / 2) return material.classes;
  std::vector<ShapeClass> each;
  for (const ShapeInfo& shape : material.shapes) each.push_back({shape.name, {shape}});
  return each;
}

PlotAxis number_axis(double last) {
  PlotAxis axis{"number i of the eigenvalue (logarithmic)", 1.0, std::max(2.0, last), {}, true};
  for (const double tick : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0}) {
    if (tick <= axis.high) axis.ticks.emplace_back(tick, to_text(tick));
  }
  return axis;
}

PlotAxis ratio_axis(double low, double high) {
  const double step = high - low > 1.2 ? 0.5 : (high - low > 0.5 ? 0.2 : 0.1);
  PlotAxis axis{"\u03bb\u1d62 / (4\u03c0 i), at unit area",
                std::floor(low / step) * step,
                std::ceil(high / step) * step,
                {}};
  const auto count = std::lround((axis.high - axis.low) / step);
  for (long i = 0; i <= count; ++i) {
    const double tick = axis.low + static_cast<double>(i) * step;
    axis.ticks.emplace_back(tick, to_text(tick, 1));
  }
  return axis;
}

Plot spectra_plot(const Material& material) {
  Plot plot;
  plot.about = "Eigenvalues of all shapes, divided by those that a shape without features has";
  const std::vector<ShapeClass> classes = series_of(material);
  const std::size_t each = std::max<std::size_t>(1, kMostCurves / classes.size());
  double low = 1.0;
  double high = 1.0;
  double last = 1.0;
  for (std::size_t c = 0; c < std::min(classes.size(), kMostCurves); ++c) {
    PlotSeries series{classes.size() > kMostLabels ? "" : classes[c].label, static_cast<int>(c)};
    for (std::size_t i = 0; i < std::min(each, classes[c].shapes.size()); ++i) {
      auto curve = curve_of(material.store.eigenvalues(classes[c].shapes[i].name));
      if (curve.empty()) continue;
      for (const auto& [x, y] : curve) {
        low = std::min(low, y);
        high = std::max(high, y);
      }
      last = std::max(last, curve.back().first);
      series.curves.push_back(std::move(curve));
    }
    if (!series.curves.empty()) plot.series.push_back(std::move(series));
  }
  plot.x = number_axis(last);
  plot.y = ratio_axis(low, std::min(high, 4.0));
  return plot;
}

}  // namespace

std::string spectra_section(const Material& material) {
  const Plot plot = spectra_plot(material);
  if (plot.series.empty()) return "";
  const std::string caption =
      "One curve for each shape, coloured by class. By Weyl\u2019s law the i-th eigenvalue of a "
      "surface of area 1 is about 4\u03c0 i, so every curve tends to 1 on the right; what lies "
      "away from 1 is the shape. Curves of one class run together: the left end hears limbs and "
      "proportions, the right end detail. Point at a curve to see its class alone.";
  return section("spectra", "Spectra over each other", figure("wide", to_svg(plot), caption));
}

}  // namespace timbre::cli
