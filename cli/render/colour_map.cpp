#include "timbre/cli/render/colour_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace timbre::cli {
namespace {

constexpr int kEntries = 257;  // odd, so that the middle is an entry

Colour diverging_at(double t) {
  constexpr double kBlue = 256.0;
  constexpr double kOrange = 55.0;
  const double out = std::abs(2.0 * t - 1.0);
  return colour_of(96.0 - 46.0 * out, 0.17 * std::pow(out, 0.85), t < 0.5 ? kBlue : kOrange);
}

// From violet over blue and green to yellow, the way light hues and dark hues lie.
Colour sequential_at(double t) {
  return colour_of(35.0 + 57.0 * t, 0.125 + 0.02 * t, 292.0 - 187.0 * t);
}

struct Hue {
  double lightness, chroma, hue;
};

// Chosen so that the least difference of any two, also as seen without red or without green
// cones, is as large as it gets near these hues.
constexpr std::array kCategories = {
    Hue{49.0, 0.15, 257.0}, Hue{71.0, 0.15, 69.0},  Hue{56.0, 0.15, 174.0}, Hue{85.0, 0.15, 100.0},
    Hue{38.0, 0.15, 329.0}, Hue{66.0, 0.15, 236.0}, Hue{54.0, 0.15, 40.0},  Hue{83.0, 0.15, 347.0},
};

struct Range {
  double low, high;
};

// Of the sorted values, those `clip` percent from the ends.
Range clipped_range(const std::vector<double>& sorted, double clip) {
  const auto last = static_cast<double>(sorted.size() - 1);
  const auto cut = static_cast<std::size_t>(clip / 100.0 * last);
  return {sorted[cut], sorted[sorted.size() - 1 - cut]};
}

Range range_of(const Eigen::VectorXd& values, ColourMapKind kind, double clip) {
  std::vector<double> sorted;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    sorted.push_back(kind == ColourMapKind::diverging ? std::abs(value) : value);
  }
  if (sorted.empty()) return {0.0, 0.0};
  std::sort(sorted.begin(), sorted.end());
  const Range range = clipped_range(sorted, clip);
  return kind == ColourMapKind::diverging ? Range{-range.high, range.high} : range;
}

double category_place(double value) {
  constexpr auto kCount = static_cast<double>(kCategories.size());
  const double category = std::fmod(std::round(value), kCount);
  return (category < 0.0 ? category + kCount : category) / (kCount - 1.0);
}

}  // namespace

ColourTable make_colour_table(ColourMapKind kind) {
  ColourTable table;
  if (kind == ColourMapKind::categorical) {
    for (const Hue& c : kCategories) table.push_back(colour_of(c.lightness, c.chroma, c.hue));
    return table;
  }
  for (int i = 0; i < kEntries; ++i) {
    const double t = static_cast<double>(i) / (kEntries - 1);
    table.push_back(kind == ColourMapKind::diverging ? diverging_at(t) : sequential_at(t));
  }
  return table;
}

ColourMapKind suggest_colour_map(const Eigen::VectorXd& values) {
  bool positive = false;
  bool negative = false;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    positive = positive || value > 0.0;
    negative = negative || value < 0.0;
  }
  return positive && negative ? ColourMapKind::diverging : ColourMapKind::sequential;
}

ColourScale scale_to_table(const Eigen::VectorXd& values, ColourMapKind kind, double clip) {
  const Range range = range_of(values, kind, kind == ColourMapKind::categorical ? 0.0 : clip);
  ColourScale scale{Eigen::VectorXd(values.size()), range.low, range.high};
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const double value = values(i);
    double& place = scale.places(i);
    if (!std::isfinite(value)) {
      place = std::numeric_limits<double>::quiet_NaN();
    } else if (kind == ColourMapKind::categorical) {
      place = category_place(value);
    } else if (range.low == range.high) {
      place = 0.5;
    } else {
      // Halves: the difference of two large numbers may be beyond a double.
      const double from_low = 0.5 * value - 0.5 * range.low;
      place = std::clamp(from_low / (0.5 * range.high - 0.5 * range.low), 0.0, 1.0);
    }
  }
  return scale;
}

}  // namespace timbre::cli
