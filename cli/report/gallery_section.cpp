#include <algorithm>

#include "timbre/analysis/core/number_text.h"
#include "timbre/cli/report/html.h"
#include "timbre/cli/report/material.h"
#include "timbre/index/query.h"

namespace timbre::cli {
namespace {

constexpr std::size_t kQueries = 6;
constexpr std::int64_t kAnswers = 5;
constexpr int kSide = 288;  // pixels

std::vector<ShapeInfo> queries_of(const Material& material) {
  std::vector<ShapeInfo> queries;
  if (!material.has_labels) {
    const std::size_t wanted = std::min(kQueries, material.shapes.size());
    return {material.shapes.begin(), material.shapes.begin() + wanted};
  }
  for (const ShapeClass& one : material.classes) {
    if (queries.size() < kQueries && !one.label.empty()) queries.push_back(one.shapes.front());
  }
  return queries;
}

std::string card(Material& material, const std::string& name, const std::string& kind,
                 const std::string& words) {
  const TriangleMesh mesh = material.store.mesh(name);
  const std::string image = material.pictures.picture({{.mesh = mesh}, "The shape " + name}, kSide);
  return figure(kind, image, element("b", escape_html(name)) + words);
}

std::string answer_card(Material& material, const ShapeInfo& query, const QueryResult& answer) {
  std::string words = element("span", {{"class", "distance"}}, to_short_text(answer.distance, 3));
  std::string kind = "answer";
  if (!query.label.empty() && !answer.label.empty()) {
    const bool is_same = query.label == answer.label;
    kind += is_same ? " same" : " other";
    words += element("span", {{"class", "mark"}},
                     (is_same ? "\u2713 same: " : "\u2717 other: ") + escape_html(answer.label));
  } else if (!answer.label.empty()) {
    words += element("span", {{"class", "mark"}}, escape_html(answer.label));
  }
  return card(material, answer.name, kind, words);
}

}  // namespace

std::string gallery_section(Material& material) {
  if (material.shapes.size() < 2) return "";
  std::string rows;
  for (const ShapeInfo& query : queries_of(material)) {
    const std::string words =
        query.label.empty() ? std::string() : element("span", escape_html(query.label));
    std::string row = card(material, query.name, "query", words);
    for (const QueryResult& answer :
         query_stored(material.store, query.name, {.count = kAnswers}).results) {
      row += answer_card(material, query, answer);
    }
    rows += element("div", {{"class", "answers"}}, row) + "\n";
  }
  const std::string about =
      "Left, a shape of the database as the question; then the five others that sound most like "
      "it, nearest first, with their distances. " +
      std::string(material.has_labels ? "A \u2713 says that the class is the same. " : "") +
      "No pose, position or size enters: only eigenvalues are compared.";
  return section("gallery", "What else looks like this one?", element("p", about) + rows);
}

}  // namespace timbre::cli
