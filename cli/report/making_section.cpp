#include <filesystem>

#include "timbre/analysis/core/number_text.h"
#include "timbre/cli/report/html.h"
#include "timbre/cli/report/material.h"
#include "timbre/cli/version.h"

namespace timbre::cli {
namespace {

std::string entry(const std::string& what, const std::string& value) {
  return element("div", element("dt", escape_html(what)) + element("dd", escape_html(value)));
}

std::string seconds_of(const EvaluationLog& log) {
  double sum = 0.0;
  for (const EvaluatedMap& map : log.maps) sum += map.seconds.value_or(0.0);
  return to_short_text(sum, 3) + " s for " + std::to_string(log.maps.size());
}

// Where a file lies is nobody's business but its owner's.
std::string short_path(const std::string& path) {
  const std::filesystem::path whole(path);
  return shell_word(whole.is_absolute() ? whole.filename().string() : path);
}

std::string own_command(const ReportInputs& inputs) {
  std::string words = "timbre report " + short_path(inputs.database) + " -o report.html";
  const auto add = [&](const char* option, const std::string& path) {
    if (!path.empty()) words += " " + std::string(option) + " " + short_path(path);
  };
  add("--set", inputs.set);
  add("--matches", inputs.matches);
  add("--maps", inputs.maps);
  add("--symmetries", inputs.symmetries);
  add("--symmetry-maps", inputs.symmetry_maps);
  if (!inputs.title.empty()) words += " --title " + shell_word(inputs.title);
  return words;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

std::string making_section(const Material& material) {
  std::int64_t vertices = 0;
  for (const ShapeInfo& shape : material.shapes) vertices += shape.vertices;
  std::string facts =
      entry("database", canonical_text(to_parameters(material.store.parameters()))) +
      entry("vertices in all", std::to_string(vertices)) +
      entry("version", first_line(version_text()));
  if (material.matches) facts += entry("time to match", seconds_of(*material.matches) + " pairs");
  if (material.symmetries) {
    facts += entry("time to find symmetries", seconds_of(*material.symmetries) + " shapes");
  }
  return section(
      "making", "How this was made",
      element("dl", {{"class", "facts"}}, facts) +
          element("p", "The page is one file and asks nothing of the network. It came from") +
          command_line(own_command(material.inputs)));
}

}  // namespace timbre::cli
