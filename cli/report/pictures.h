#pragma once

#include <string>
#include <vector>

#include "timbre/analysis/core/progress.h"
#include "timbre/cli/render/render.h"

namespace timbre::cli {

struct PictureOptions {
  UpAxis up = UpAxis::y;
  int threads = 0;         ///< 0: all cores
  Progress progress = {};  ///< counts pictures
};

/// A surface, a name for it, and how large to draw it.
struct PictureRequest {
  SurfaceLook look;
  std::string alt;  ///< what the picture shows, for those who do not see it
  View view = {38.0, 20.0};
};

/// Makes the pictures of a page: transparent, so that they stand on light and on dark.
class PictureMaker {
 public:
  explicit PictureMaker(const PictureOptions& options)
      : options_(options), reporter_(options.progress, "pictures", 0) {}

  [[nodiscard]] UpAxis up() const { return options_.up; }
  [[nodiscard]] int threads() const { return options_.threads; }
  [[nodiscard]] const Progress& progress() const { return options_.progress; }

  /// An `img` of a surface; a mesh that has nothing to draw becomes words.
  /// @param side  pixels; shown at half of it where screens are fine
  [[nodiscard]] std::string picture(const PictureRequest& request, int side);

 private:
  PictureOptions options_;
  ProgressReporter reporter_;
};

/// The strip of a colour table with words at its ends.
[[nodiscard]] std::string colour_strip(ColourMapKind kind, const std::string& low,
                                       const std::string& high);

/// Colours of values on a table; NaN where a value is not finite.
/// @param low, high  what the ends of the table stand for
[[nodiscard]] VertexColours table_colours(const Eigen::VectorXd& values, ColourMapKind kind,
                                          double low, double high);

/// `#rrggbb` of an sRGB colour.
[[nodiscard]] std::string to_hex(const Colour& colour);

}  // namespace timbre::cli
