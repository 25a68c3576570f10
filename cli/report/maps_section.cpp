#include <algorithm>
#include <filesystem>
#include <system_error>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"
#include "timbre/cli/command.h"
#include "timbre/cli/report/html.h"
#include "timbre/cli/report/material.h"
#include "timbre/cli/report/plot.h"
#include "timbre/cli/report/viewer.h"
#include "timbre/datasets/map_scores.h"
#include "timbre/datasets/truth.h"

namespace timbre::cli {
namespace {

constexpr std::size_t kMostPairs = 4;
constexpr int kSide = 360;  // pixels
// Points whose errors are measured; those between take the colours of their neighbours.
constexpr std::size_t kMostErrors = 1200;
constexpr double kWorstShown = 15.0;  // error at the end of the colours

/// A pair of the log with its surfaces and its map.
struct Pair {
  const EvaluatedMap& result;
  TriangleMesh source, target;
  std::vector<std::int32_t> map;
  VertexColours source_colours = {}, target_colours = {};
};

std::string map_file(const Material& material, const EvaluatedMap& result) {
  const std::string name = shape_stem(result.source) + "_" + shape_stem(result.target) + ".txt";
  return (std::filesystem::path(material.inputs.maps) / name).string();
}

Pair load_pair(const Material& material, const EvaluatedMap& result) {
  Pair pair{result, mesh_of(material, result.source), mesh_of(material, result.target), {}};
  const std::string file = map_file(material, result);
  pair.map = read_vertex_list(file, 0, pair.target.vertices.rows());
  for_file(file, [&] {
    const VertexColours colours = position_colours(pair.source, material.inputs.pictures.up);
    pair.target_colours = carry_colours(colours, pair.map, pair.target);
    pair.source_colours = matched_colours(colours, pair.map);
  });
  return pair;
}

// The target's points in the colours of the errors with which they were met; nothing where the
// truth is not known.
VertexColours error_colours(const Material& material, const Pair& pair) {
  if (!material.set) return {};
  const ShapeSet& set = *material.set;
  const Truth truth =
      map_truth(set, find_shape(set, pair.result.source), pair.source.vertices.rows(),
                find_shape(set, pair.result.target), pair.target.vertices.rows());
  const std::size_t step = 1 + truth.source.size() / kMostErrors;
  std::vector<std::int32_t> from, to;
  for (std::size_t row = 0; row < truth.source.size(); ++row) {
    const std::int32_t image = pair.map[static_cast<std::size_t>(truth.source[row])];
    if (image < 0 || row % step != 0) continue;
    from.push_back(image);
    to.push_back(truth.target[row]);
  }
  if (to.empty()) return {};
  const std::vector<double> errors = ErrorScale(pair.target, GeodesicKind::graph)
                                         .between(from, to, material.inputs.pictures.threads);
  const VertexColours colours = table_colours(
      Eigen::Map<const Eigen::VectorXd>(errors.data(), static_cast<Eigen::Index>(errors.size())),
      ColourMapKind::sequential, 0.0, kWorstShown);
  return carry_colours(colours, to, pair.target);
}

std::string percent(double share) { return to_text(100.0 * share, 0) + "\u202f%"; }

std::string verdict_of(const EvaluatedMap& result) {
  std::string words =
      result.error ? "mean error " + to_text(*result.error, 2) : "no point answered";
  words += ", " + percent(result.below5) + " within 5";
  if (!result.verdict.empty()) words += ", verdict: " + escape_html(result.verdict);
  if (result.flipped.value_or(false)) words += ", left and right exchanged";
  if (result.seconds) words += ", " + to_short_text(*result.seconds, 2) + " s";
  return words;
}

std::string shown(Material& material, const TriangleMesh& mesh, const VertexColours& colours,
                  const std::string& name, const std::string& about, const std::string& words) {
  const std::string image = material.pictures.picture(
      {{.mesh = mesh, .colours = colours}, "The shape " + name + " " + about}, kSide);
  return figure("card", image, element("b", escape_html(name)) + element("span", words));
}

std::string pair_figures(Material& material, const Pair& pair) {
  return shown(material, pair.source, pair.source_colours, shape_stem(pair.result.source),
               "coloured by position", "coloured by position") +
         shown(material, pair.target, pair.target_colours, shape_stem(pair.result.target),
               "in colours brought by the map", "colours brought by the map");
}

constexpr char kAboutErrors[] =
    "The truth of this pair is known. Here the target is coloured by how far its points are from "
    "where the map should have put them.";

std::string error_strip() {
  return colour_strip(ColourMapKind::sequential, "error 0", to_text(kWorstShown) + " and more");
}

std::string pair_html(Material& material, const Pair& pair, bool is_first) {
  const std::string heading = escape_html(shape_stem(pair.result.source)) + " \u2192 " +
                              escape_html(shape_stem(pair.result.target));
  std::string html =
      element("h3", heading) + element("p", {{"class", "verdict"}}, verdict_of(pair.result));
  const std::string pictures = pair_figures(material, pair);
  const VertexColours errors = error_colours(material, pair);
  const std::string wrong =
      errors.rows() == 0 ? ""
                         : shown(material, pair.target, errors, shape_stem(pair.result.target),
                                 "coloured by the error of the map", "how far off the map is");
  if (!is_first) return html + element("div", {{"class", "cards three"}}, pictures + wrong);
  html += viewer({pair.source, pair.source_colours, shape_stem(pair.result.source)},
                 {pair.target, pair.target_colours, shape_stem(pair.result.target)}, pair.map,
                 material.inputs.pictures.up, element("div", {{"class", "cards two"}}, pictures));
  if (wrong.empty()) return html;
  return html + element("div", {{"class", "beside"}},
                        wrong + element("div", element("p", kAboutErrors) + error_strip()));
}

std::string curve_figure(const EvaluationLog& log) {
  Plot plot;
  plot.about = "Share of points against the error allowed";
  plot.height = 340.0;
  plot.x = {"error allowed, in hundredths of the target\u2019s size", 0.0, 25.0, {}};
  plot.y = {"share of points", 0.0, 1.0, {}};
  for (int i = 0; i <= 5; ++i) plot.x.ticks.emplace_back(5.0 * i, std::to_string(5 * i));
  for (int i = 0; i <= 4; ++i) plot.y.ticks.emplace_back(0.25 * i, std::to_string(25 * i) + " %");
  PlotSeries each{"", 5};
  PlotSeries mean{"mean", 0, true};
  for (const EvaluatedMap& map : log.maps) {
    std::vector<std::pair<double, double>> curve;
    for (std::size_t i = 0; i < map.pck.size(); ++i) {
      curve.emplace_back(kPckStep * static_cast<double>(i), map.pck[i]);
    }
    if (mean.curves.empty()) mean.curves.emplace_back(curve.size());
    std::vector<std::pair<double, double>>& sum = mean.curves[0];
    sum.resize(std::min(sum.size(), curve.size()));
    for (std::size_t i = 0; i < sum.size(); ++i) {
      sum[i].first = curve[i].first;
      sum[i].second += curve[i].second / static_cast<double>(log.maps.size());
    }
    if (each.curves.size() < 200) each.curves.push_back(std::move(curve));
  }
  if (mean.curves.empty() || mean.curves[0].empty()) return "";
  plot.series = {each, mean};
  return figure("wide", to_svg(plot),
                "How many points are right, if errors up to the number below are forgiven: the "
                "mean over " +
                    std::to_string(log.maps.size()) +
                    " maps, and each of them. The error of a point is its distance on the target "
                    "from where it should be, over the square root of the area, times 100.");
}

}  // namespace

std::string maps_section(Material& material) {
  if (!material.matches || material.matches->maps.empty()) return "";
  std::string pairs;
  std::size_t count = 0;
  for (const EvaluatedMap& result : material.matches->maps) {
    if (material.inputs.maps.empty() || count == kMostPairs) break;
    // A log may be longer than the folder of maps that were kept.
    std::error_code failure;
    if (!std::filesystem::exists(map_file(material, result), failure)) continue;
    pairs += pair_html(material, load_pair(material, result), count == 0);
    ++count;
  }
  const std::string about =
      count == 0 ? "How far maps between two poses are from the truth."
                 : "Which point of one is which point of the other? The first of each pair is "
                   "coloured by position; the second has the colours that the map brings to it. "
                   "Equal colours are matched points.";
  return section("maps", "Maps", element("p", about) + pairs + curve_figure(*material.matches));
}

}  // namespace timbre::cli
