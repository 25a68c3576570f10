#include <cmath>
#include <filesystem>
#include <set>

#include "timbre/analysis/core/number_text.h"
#include "timbre/cli/report/html.h"
#include "timbre/cli/report/material.h"
#include "timbre/datasets/map_scores.h"
#include "timbre/datasets/metrics.h"
#include "timbre/index/gallery.h"

namespace timbre::cli {
namespace {

// All pairs of shapes are compared: of more it takes minutes.
constexpr std::size_t kMostShapes = 10000;

using Row = std::vector<TableCell>;

Row score_row(const std::string& name, std::int64_t queries, const RetrievalScores& scores) {
  Row row = {{name}, {std::to_string(queries), true}};
  for (const double value : {scores.average_precision, scores.nearest, scores.first_tier,
                             scores.second_tier, scores.e_measure, scores.dcg}) {
    row.push_back({to_text(value, 3), true});
  }
  return row;
}

bool can_be_evaluated(const Material& material) {
  if (material.shapes.size() > kMostShapes) return false;
  for (const ShapeClass& one : material.classes) {
    if (!one.label.empty() && one.shapes.size() > 1) return true;
  }
  return false;
}

std::string retrieval(const Material& material) {
  if (!can_be_evaluated(material)) return "";
  const Gallery gallery = load_gallery(material.store, find_channel(kDefaultChannel));
  std::vector<std::string> labels;
  for (std::int64_t i = 0; i < gallery.size(); ++i) labels.push_back(gallery.shape(i).label);
  const RetrievalReport report = evaluate_retrieval(
      labels, [&](Eigen::Index i) { return gallery.distances(gallery.vector(i)); });
  std::vector<Row> rows = {score_row("all queries", report.queries, report.micro)};
  for (const ClassScores& one : report.classes) {
    rows.push_back(score_row(one.label, one.queries, one.mean));
  }
  const Row head = {{"class"},    {"queries", true}, {"mAP", true}, {"NN", true},
                    {"FT", true}, {"ST", true},      {"E", true},   {"DCG", true}};
  return element("h3", "Retrieval") +
         element("p",
                 "Every shape asks once for the others: do those of its class come first? mAP is "
                 "the mean average precision, NN the share whose nearest neighbour is right, FT "
                 "and ST the share of the class among the first C and 2C answers, E the measure "
                 "of the first 32 answers, DCG the discounted gain. 1 is perfect.") +
         table("Retrieval by " + std::string(kDefaultChannel), head, rows) +
         command_line(
             "timbre eval retrieval " +
             shell_word(std::filesystem::path(material.inputs.database).filename().string()));
}

struct Means {
  double error = 0.0, found = 0.0, right = 0.0, flipped = 0.0, meshes = 0.0, seconds = 0.0;
  double answered = 0.0, sided = 0.0, timed = 0.0;
};

Means means_of(const EvaluationLog& log) {
  Means sum;
  const auto n = static_cast<double>(log.maps.size());
  for (const EvaluatedMap& map : log.maps) {
    if (map.error) ++sum.answered, sum.error += *map.error;
    if (map.flipped) ++sum.sided, sum.flipped += *map.flipped ? 1.0 : 0.0;
    if (map.seconds) ++sum.timed, sum.seconds += *map.seconds;
    sum.found += map.found ? 1.0 / n : 0.0;
    sum.right += map.right / n;
    sum.meshes += map.right > kSymmetryShare ? 1.0 / n : 0.0;
  }
  sum.error /= sum.answered;
  sum.flipped /= sum.sided;
  sum.seconds /= sum.timed;
  return sum;
}

TableCell number(double value, int digits) {
  return {std::isfinite(value) ? to_text(value, digits) : "\u2013", true};
}

TableCell percent(double share) {
  return {std::isfinite(share) ? to_text(100.0 * share, 1) + " %" : "\u2013", true};
}

std::string eval_command(const EvaluationLog& log) {
  // A folder as it was given; of one from the root only the last part, which is the same elsewhere.
  const std::filesystem::path folder(log.set);
  std::string words = "timbre eval match " +
                      shell_word(folder.is_absolute() ? folder.filename().string() : log.set);
  if (log.kind == "sym") words += " --kind sym";
  if (!log.maps_folder.empty()) words += " --maps " + shell_word(log.maps_folder);
  if (log.method == "functional") words += " --method functional";
  if (log.geodesic != "exact") words += " --geodesic " + shell_word(log.geodesic);
  if (log.count != 200) words += " -k " + std::to_string(log.count);
  if (log.samples != 0) words += " --samples " + std::to_string(log.samples);
  return words + " -n " + std::to_string(log.maps.size());
}

std::string matching(const Material& material) {
  if (!material.matches || material.matches->maps.empty()) return "";
  const Means means = means_of(*material.matches);
  const Row head = {{""},
                    {"pairs", true},
                    {"mean error", true},
                    {"found", true},
                    {"flipped", true},
                    {"seconds each", true}};
  const Row row = {{"maps"},
                   {std::to_string(material.matches->maps.size()), true},
                   number(means.error, 2),
                   percent(means.found),
                   percent(means.flipped),
                   number(means.seconds, 1)};
  return element("h3", "Matching") +
         element("p",
                 "A map is found if its mean error is below 5 and every point has an answer (nine "
                 "tenths, for parts); "
                 "flipped, if it fits the truth better with left and right exchanged.") +
         table("Maps between poses", head, {row}) + command_line(eval_command(*material.matches));
}

std::string symmetry(const Material& material) {
  if (!material.symmetries || material.symmetries->maps.empty()) return "";
  const Means means = means_of(*material.symmetries);
  const Row head = {{""},
                    {"shapes", true},
                    {"mean error", true},
                    {"mesh rate", true},
                    {"correspondence rate", true},
                    {"seconds each", true}};
  const Row row = {{"reflections"},        {std::to_string(material.symmetries->maps.size()), true},
                   number(means.error, 2), percent(means.meshes),
                   percent(means.right),   number(means.seconds, 1)};
  return element("h3", "Symmetry") +
         element("p",
                 "The correspondence rate is the share of points whose mirror image is nearer "
                 "than " +
                     to_text(kSymmetryError, 1) +
                     " to the right one; the mesh rate the share of shapes for which this holds "
                     "of more than three quarters of the points.") +
         table("Left-right symmetry", head, {row}) +
         command_line(eval_command(*material.symmetries));
}

}  // namespace

std::string figures_section(const Material& material) {
  const std::string content = retrieval(material) + matching(material) + symmetry(material);
  return content.empty() ? "" : section("figures", "Figures", content);
}

}  // namespace timbre::cli
