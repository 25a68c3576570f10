#include "timbre/cli/report/pictures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "timbre/analysis/core/error.h"
#include "timbre/cli/render/image.h"
#include "timbre/cli/report/html.h"

namespace timbre::cli {

std::string PictureMaker::picture(const PictureRequest& request, int side) {
  std::vector<Image> images;
  try {
    images =
        render(request.look, {request.view},
               {.width = side, .height = side, .up = options_.up, .threads = options_.threads});
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::bad_input) throw;
    return element("p", {{"class", "nothing"}}, "Nothing to draw: " + escape_html(error.cause()));
  }
  reporter_.advance();
  const std::string shown = std::to_string(side / 2);
  return "<img src=\"data:image/png;base64," + to_base64(to_png(images[0])) + "\" width=\"" +
         shown + "\" height=\"" + shown + "\" alt=\"" + escape_html(request.alt) + "\">";
}

std::string to_hex(const Colour& colour) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text = "#";
  for (const float channel : colour) {
    const auto byte = static_cast<std::size_t>(std::lround(255.0F * std::clamp(channel, 0.F, 1.F)));
    text += {kDigits[byte / 16], kDigits[byte % 16]};
  }
  return text;
}

std::string colour_strip(ColourMapKind kind, const std::string& low, const std::string& high) {
  const ColourTable colours = make_colour_table(kind);
  constexpr std::size_t kStops = 9;
  std::string gradient = "background:linear-gradient(to right";
  for (std::size_t i = 0; i < kStops; ++i) {
    gradient += "," + to_hex(colours[i * (colours.size() - 1) / (kStops - 1)]);
  }
  return element("span", {{"class", "strip"}},
                 element("span", escape_html(low)) +
                     element("span", {{"class", "ramp"}, {"style", gradient + ")"}}, "") +
                     element("span", escape_html(high)));
}

VertexColours table_colours(const Eigen::VectorXd& values, ColourMapKind kind, double low,
                            double high) {
  const ColourTable table = make_colour_table(kind);
  VertexColours colours(values.size(), 3);
  for (Eigen::Index v = 0; v < values.size(); ++v) {
    if (!std::isfinite(values(v))) {
      colours.row(v).setConstant(std::numeric_limits<float>::quiet_NaN());
      continue;
    }
    const double place = std::clamp((values(v) - low) / (high - low), 0.0, 1.0);
    const auto last = static_cast<double>(table.size() - 1);
    colours.row(v) = table[static_cast<std::size_t>(std::lround(place * last))].transpose();
  }
  return colours;
}

}  // namespace timbre::cli
