#include "timbre/cli/report/plot.h"

#include <algorithm>
#include <cmath>

#include "timbre/analysis/core/number_text.h"
#include "timbre/cli/report/html.h"

namespace timbre::cli {
namespace {

// In units of the drawing, which is scaled to the width of the page. On a narrow one it keeps
// its size and scrolls: letters would be too small.
constexpr double kWidth = 960.0;
constexpr double kLeft = 76.0;
constexpr double kTop = 14.0;
constexpr double kBottom = 54.0;
constexpr double kLetter = 8.8;     // mean width, of a label's letters
constexpr double kLine = 17.0;      // from one label to the next
constexpr double kLeader = 34.0;    // from a curve's end to its label
constexpr std::size_t kDashes = 8;  // colours; after these they come again with dashes

// A name of as many letters as eyes count, not bytes.
double width_of(const std::string& label) {
  const auto letters = std::count_if(label.begin(), label.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0U) != 0x80;
  });
  return kLetter * static_cast<double>(std::min<std::ptrdiff_t>(letters, 22));
}

double share_on(const PlotAxis& axis, double value) {
  if (!axis.is_logarithmic) return (value - axis.low) / (axis.high - axis.low);
  return std::log(value / axis.low) / std::log(axis.high / axis.low);
}

std::string number(double value) { return to_text(std::round(10.0 * value) / 10.0); }

struct Frame {
  const Plot& plot;
  double right;  ///< where the curves end and their labels begin

  [[nodiscard]] double x(double value) const {
    return kLeft + (right - kLeft) * share_on(plot.x, value);
  }
  [[nodiscard]] double y(double value) const {
    return bottom() - (bottom() - kTop) * share_on(plot.y, value);
  }
  [[nodiscard]] double bottom() const { return plot.height - kBottom; }
};

std::string line(double x1, double y1, double x2, double y2, const char* kind) {
  return "<path class=\"" + std::string(kind) + "\" d=\"M" + number(x1) + " " + number(y1) + "L" +
         number(x2) + " " + number(y2) + "\"/>";
}

std::string text(double x, double y, const char* kind, const std::string& words) {
  return element("text", {{"x", number(x)}, {"y", number(y)}, {"class", kind}},
                 escape_html(words)) +
         "\n";
}

std::string axes(const Frame& frame) {
  const double bottom = frame.bottom();
  std::string svg;
  for (const auto& [value, words] : frame.plot.y.ticks) {
    const double y = frame.y(value);
    svg += line(kLeft, y, frame.right, y, "grid") + text(kLeft - 8.0, y + 4.5, "end", words);
  }
  for (const auto& [value, words] : frame.plot.x.ticks) {
    const double x = frame.x(value);
    svg += line(x, bottom, x, bottom + 5.0, "axis") + text(x, bottom + 20.0, "middle", words);
  }
  svg += line(kLeft, bottom, frame.right, bottom, "axis");
  svg += text((kLeft + frame.right) / 2.0, frame.plot.height - 10.0, "middle title",
              frame.plot.x.title);
  const double middle = (kTop + bottom) / 2.0;
  svg += element("text",
                 {{"class", "middle title"},
                  {"transform", "translate(16 " + number(middle) + ") rotate(-90)"}},
                 escape_html(frame.plot.y.title));
  return svg + "\n";
}

std::string path(const Frame& frame, const std::vector<std::pair<double, double>>& curve) {
  std::string data;
  for (const auto& [x, y] : curve) {
    const double inside = std::clamp(y, frame.plot.y.low, frame.plot.y.high);
    data += (data.empty() ? "M" : " ") + number(frame.x(x)) + " " + number(frame.y(inside));
  }
  return "<path d=\"" + data + "\"/>";
}

// The mean height at which a series ends.
double end_of(const Frame& frame, const PlotSeries& series) {
  double sum = 0.0;
  for (const auto& curve : series.curves) {
    sum += frame.y(std::clamp(curve.back().second, frame.plot.y.low, frame.plot.y.high));
  }
  return sum / static_cast<double>(series.curves.size());
}

// Where the labels of series stand, in the order of the series.
struct Labels {
  std::vector<double> heights;
  bool are_near = true;  ///< each beside its curve; otherwise they are a list
};

// Labels beside the ends of their curves, a line apart. Where that would lead far away, as all
// curves end together, an even list with a sample of each line reads better.
Labels place_labels(const Frame& frame, const std::vector<double>& ends) {
  std::vector<std::size_t> order(ends.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return ends[a] < ends[b]; });
  Labels labels{std::vector<double>(ends.size())};
  double least = kTop;
  for (const std::size_t i : order) {
    labels.heights[i] = std::max(least, ends[i]);
    least = labels.heights[i] + kLine;
    if (labels.heights[i] - ends[i] > 2.0 * kLine) labels.are_near = false;
  }
  if (labels.are_near) return labels;
  const double room = frame.bottom() - kTop;
  const double step = std::min(1.3 * kLine, room / static_cast<double>(ends.size()));
  for (std::size_t i = 0; i < ends.size(); ++i) {
    labels.heights[i] = kTop + step * (static_cast<double>(i) + 0.5);
  }
  return labels;
}

std::string label(const Frame& frame, const PlotSeries& series, double height, bool is_near) {
  const double from = is_near ? end_of(frame, series) : height;
  return "<path class=\"leader\" d=\"M" + number(frame.right + 3.0) + " " + number(from) + "L" +
         number(frame.right + kLeader - 12.0) + " " + number(height) + "h6\"/>" +
         text(frame.right + kLeader, height + 5.0, "label", series.label);
}

std::string draw(const Frame& frame, const PlotSeries& series, const std::string& label_svg) {
  const auto style = static_cast<std::size_t>(std::max(0, series.style));
  std::string kind = "series c" + std::to_string(style % kDashes);
  if (style / kDashes % 3 == 1) kind += " dashed";
  if (style / kDashes % 3 == 2) kind += " dotted";
  if (series.is_bold) kind += " bold";
  std::string svg;
  for (const auto& curve : series.curves) svg += path(frame, curve);
  return element("g", {{"class", kind}}, svg + label_svg) + "\n";
}

}  // namespace

std::string to_svg(const Plot& plot) {
  double widest = 0.0;
  for (const PlotSeries& series : plot.series) widest = std::max(widest, width_of(series.label));
  const Frame frame{plot, kWidth - (widest > 0.0 ? widest + kLeader : 12.0) - 6.0};
  std::vector<double> ends;
  for (const PlotSeries& series : plot.series) {
    if (!series.label.empty()) ends.push_back(end_of(frame, series));
  }
  const Labels labels = place_labels(frame, ends);
  std::string svg = axes(frame);
  std::size_t labelled = 0;
  for (const PlotSeries& series : plot.series) {
    const bool has_label = !series.label.empty();
    svg += draw(frame, series,
                has_label ? label(frame, series, labels.heights[labelled++], labels.are_near) : "");
  }
  const std::string drawing =
      element("svg",
              {{"viewBox", "0 0 " + number(kWidth) + " " + number(plot.height)},
               {"role", "img"},
               {"aria-label", plot.about}},
              "\n" + svg);
  return element("div", {{"class", "plot"}, {"tabindex", "0"}}, drawing);
}

}  // namespace timbre::cli
