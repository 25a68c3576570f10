#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "timbre/cli/render/colour_space.h"

namespace timbre::cli {

enum class ColourMapKind : std::uint8_t {
  diverging,    ///< blue, nearly white at 0, orange: for signed values
  sequential,   ///< dark to light: for amounts and distances
  categorical,  ///< unlike neighbours: for labels 0, 1, ...
};

/// sRGB colours along [0, 1], evenly spaced, with interpolation between.
using ColourTable = std::vector<Colour>;

/// Lightness changes evenly along the continuous maps, so that they also read in grey and
/// with any colour vision; the diverging one is as light at -v as at v.
[[nodiscard]] ColourTable make_colour_table(ColourMapKind kind);

/// `diverging` if there are values of both signs, else `sequential`.
[[nodiscard]] ColourMapKind suggest_colour_map(const Eigen::VectorXd& values);

/// Values as places in a colour table.
struct ColourScale {
  Eigen::VectorXd places;  ///< n, in [0, 1]; NaN where the value is not finite
  double low = 0.0;        ///< the value at place 0
  double high = 0.0;       ///< the value at place 1
};

/// Spreads values over a table: the diverging one evenly about 0, the sequential one from the
/// smallest to the largest, both after `clip` percent at each end are cut to the nearest
/// value that is left. Categories are rounded to integers, and repeat.
[[nodiscard]] ColourScale scale_to_table(const Eigen::VectorXd& values, ColourMapKind kind,
                                         double clip = 0.0);

}  // namespace timbre::cli
