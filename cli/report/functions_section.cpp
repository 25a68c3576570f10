#include <array>
#include <cmath>
#include <numbers>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"
#include "timbre/analysis/signatures/heat_kernel.h"
#include "timbre/analysis/spectrum/spectrum.h"
#include "timbre/cli/report/html.h"
#include "timbre/cli/report/material.h"

namespace timbre::cli {
namespace {

constexpr int kSide = 288;   // pixels
constexpr int kPairs = 100;  // eigenpairs, of which signatures are made
constexpr std::array kShown = {1, 2, 3, 5, 8, 13};

struct HeatTime {
  int column;  ///< of the 64 times
  const char* words;
};
constexpr std::array kTimes = {HeatTime{2, "small"}, HeatTime{22, "medium"}, HeatTime{42, "large"}};

// The shape in the middle: of many classes the first is often one of the simplest.
const ShapeInfo& chosen_shape(const Material& material) {
  return material.classes[material.classes.size() / 2].shapes.front();
}

std::string eigenfunction(Material& material, const TriangleMesh& mesh, const Spectrum& spectrum,
                          int i) {
  const Eigen::VectorXd values = spectrum.vectors.col(i);
  SurfaceLook look{.mesh = mesh};
  look.field = ColourField{scale_to_table(values, ColourMapKind::diverging).places,
                           make_colour_table(ColourMapKind::diverging)};
  look.lines = Isolines{values, {0.0}};
  const std::string number = std::to_string(i);
  const std::string image =
      material.pictures.picture({look, "Eigenfunction " + number + " in colours"}, kSide);
  return figure("card", image,
                element("b", "\u03c6<sub>" + number + "</sub>") +
                    element("span", "\u03bb = " + to_short_text(spectrum.values(i), 3)));
}

std::string heat_kernel(Material& material, const TriangleMesh& mesh, const Spectrum& spectrum,
                        const HeatTime& time) {
  const Eigen::VectorXd times = heat_kernel_times(spectrum);
  const Eigen::VectorXd values =
      compute_heat_kernel_signature(spectrum, times.segment(time.column, 1)).col(0);
  SurfaceLook look{.mesh = mesh};
  look.field = ColourField{scale_to_table(values, ColourMapKind::sequential, 1.0).places,
                           make_colour_table(ColourMapKind::sequential)};
  const std::string image = material.pictures.picture(
      {look, "Heat kernel signature at a " + std::string(time.words) + " time in colours"}, kSide);
  return figure("card", image,
                element("b", std::string(time.words) + " time") +
                    element("span", "t = " + to_short_text(times(time.column), 2)));
}

Spectrum spectrum_of(const Material& material, const TriangleMesh& mesh) {
  const StoreParameters& parameters = material.store.parameters();
  const Operator op =
      compute_operator(mesh, {.kind = parameters.operator_kind, .mass = parameters.mass});
  const int zeros = count_zeros(op);
  Spectrum spectrum = compute_spectrum(op, {.count = kPairs + zeros,
                                            .certify = false,
                                            .threads = material.pictures.threads(),
                                            .progress = material.pictures.progress()});
  return at_unit_area(at_vertices(std::move(spectrum), op), op.area);
}

}  // namespace

std::string functions_section(Material& material) {
  const ShapeInfo& shape = chosen_shape(material);
  const TriangleMesh mesh = material.store.mesh(shape.name);
  const Spectrum spectrum = spectrum_of(material, mesh);
  if (spectrum.values.size() <= spectrum.zeros) return "";
  std::string waves;
  for (const int i : kShown) {
    if (i < spectrum.values.size()) waves += eigenfunction(material, mesh, spectrum, i);
  }
  std::string heat;
  for (const HeatTime& time : kTimes) heat += heat_kernel(material, mesh, spectrum, time);
  const std::string about =
      "The surface " + element("b", escape_html(shape.name)) +
      ", swinging. Each eigenfunction is one way it can: blue and orange parts move against each "
      "other, and the dark lines between them stay still. Higher ones have more and smaller parts.";
  const std::string warmth =
      "The heat kernel signature of the same surface: how much of the heat put on a point is "
      "still there after a while. At first tips keep it best, later whole limbs.";
  return section("functions", "What the eigenfunctions look like",
                 element("p", about) + element("div", {{"class", "cards"}}, waves) +
                     element("p", {{"class", "key"}},
                             colour_strip(ColourMapKind::diverging, "one way", "the other")) +
                     element("h3", "Heat that stays") + element("p", warmth) +
                     element("div", {{"class", "cards"}}, heat) +
                     element("p", {{"class", "key"}},
                             colour_strip(ColourMapKind::sequential, "little heat left", "much")));
}

}  // namespace timbre::cli
