#include <algorithm>

#include "timbre/cli/report/html.h"
#include "timbre/cli/report/material.h"
#include "timbre/index/channel.h"

namespace timbre::cli {
namespace {

constexpr std::size_t kHeroes = 6;
constexpr int kHeroSide = 360;  // pixels

std::string count(const std::string& what, const std::string& value) {
  return element("div", element("dt", escape_html(what)) + element("dd", escape_html(value)));
}

// One of each class, so that the row shows what there is; without classes the first shapes.
std::vector<ShapeInfo> heroes(const Material& material) {
  std::vector<ShapeInfo> chosen;
  const std::size_t classes = material.classes.size();
  if (classes == 1) return first_shapes(material, kHeroes);
  // Spread over all classes, which are often sorted by kind.
  for (std::size_t i = 0; i < std::min(kHeroes, classes); ++i) {
    chosen.push_back(material.classes[i * classes / std::min(kHeroes, classes)].shapes.front());
  }
  return chosen;
}

}  // namespace

std::string header_section(Material& material, const std::string& title) {
  std::string row;
  for (const ShapeInfo& shape : heroes(material)) {
    const TriangleMesh mesh = material.store.mesh(shape.name);
    row += material.pictures.picture({{.mesh = mesh}, "The shape " + shape.name}, kHeroSide);
  }
  std::string counts = count("shapes", std::to_string(material.shapes.size()));
  const auto classes = std::count_if(material.classes.begin(), material.classes.end(),
                                     [](const ShapeClass& one) { return !one.label.empty(); });
  if (classes > 0) counts += count("classes", std::to_string(classes));
  counts += count("eigenvalues of each", std::to_string(material.store.parameters().count));
  counts += count("compared by", kDefaultChannel);
  const std::string lead =
      "Surfaces that are known by what they sound like: for each, the lowest eigenvalues of its "
      "Laplace\u2013Beltrami operator, the squares of the tones it would have as a drum. They stay "
      "the same when a body bends, so they tell what it is in any pose.";
  return element("header", element("h1", escape_html(title)) +
                               element("p", {{"class", "lead"}}, lead) +
                               element("div", {{"class", "hero"}}, row) +
                               element("dl", {{"class", "counts"}}, counts)) +
         "\n<main>\n";
}

}  // namespace timbre::cli
