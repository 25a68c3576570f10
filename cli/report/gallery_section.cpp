#include <algorithm>
#include <map>

#include "timbre/analysis/core/number_text.h"
#include "timbre/cli/report/html.h"
#include "timbre/cli/report/material.h"
#include "timbre/index/query.h"

namespace timbre::cli {
namespace {

constexpr std::size_t kQueries = 6;
constexpr std::int64_t kAnswers = 5;
constexpr int kSide = 256;  // pixels

std::vector<ShapeInfo> queries_of(const Material& material) {
  std::vector<ShapeInfo> queries;
  if (!material.has_labels) return first_shapes(material, kQueries);
  for (const ShapeClass& one : material.classes) {
    if (queries.size() < kQueries && !one.label.empty()) queries.push_back(one.shapes.front());
  }
  return queries;
}

/// Thumbnails of shapes by name; many are answers to several questions.
class Thumbnails {
 public:
  explicit Thumbnails(Material& material) : material_(material) {}

  [[nodiscard]] const std::string& of(const std::string& name) {
    std::string& image = made_[name];
    if (image.empty()) {
      const TriangleMesh mesh = material_.store.mesh(name);
      image = material_.pictures.picture({{.mesh = mesh}, "The shape " + name}, kSide);
    }
    return image;
  }

 private:
  Material& material_;
  std::map<std::string, std::string> made_;
};

std::string card(Thumbnails& thumbnails, const std::string& name, const std::string& kind,
                 const std::string& words) {
  return figure(kind, thumbnails.of(name), element("b", escape_html(name)) + words);
}

// How many answers can be of the same class.
std::string query_words(const Material& material, const ShapeInfo& query) {
  if (query.label.empty()) return element("span", "question");
  std::size_t others = 0;
  for (const ShapeClass& one : material.classes) {
    if (one.label == query.label) others = one.shapes.size() - 1;
  }
  return element("span", escape_html(query.label)) +
         element("span", "has " + std::to_string(others) + " more");
}

std::string answer_card(Thumbnails& thumbnails, const ShapeInfo& query, const QueryResult& answer) {
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
  return card(thumbnails, answer.name, kind, words);
}

}  // namespace

std::string gallery_section(Material& material) {
  if (material.shapes.size() < 2) return "";
  Thumbnails thumbnails(material);
  std::string rows;
  for (const ShapeInfo& query : queries_of(material)) {
    std::string row = card(thumbnails, query.name, "query", query_words(material, query));
    for (const QueryResult& answer :
         query_stored(material.store, query.name, {.count = kAnswers}).results) {
      row += answer_card(thumbnails, query, answer);
    }
    rows += element("div", {{"class", "answers"}}, row) + "\n";
  }
  const std::string about =
      "First in each row a shape of the database as the question; then the five others that sound "
      "most like "
      "it, nearest first, with their distances. " +
      std::string(material.has_labels ? "A \u2713 says that the class is the same; under each "
                                        "question stands how many answers can be. "
                                      : "") +
      "No pose, position or size enters: only eigenvalues are compared.";
  return section("gallery", "What else looks like this one?", element("p", about) + rows);
}

}  // namespace timbre::cli
