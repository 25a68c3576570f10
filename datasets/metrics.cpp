#include "timbre/datasets/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "timbre/analysis/core/error.h"

namespace timbre {
namespace {

constexpr std::size_t kEMeasureLength = 32;

double gain(std::size_t index) {
  return index == 0 ? 1.0 : 1.0 / std::log2(static_cast<double>(index + 1));
}

double finite_or_last(double distance) {
  return std::isfinite(distance) ? distance : std::numeric_limits<double>::infinity();
}

std::vector<bool> ranked_relevance(std::span<const double> distances,
                                   const std::vector<bool>& relevant) {
  std::vector<std::size_t> order(distances.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const double da = finite_or_last(distances[a]);
    const double db = finite_or_last(distances[b]);
    return da < db || (da == db && !relevant[a] && relevant[b]);
  });
  std::vector<bool> ranked;
  ranked.reserve(order.size());
  for (const std::size_t i : order) ranked.push_back(relevant[i]);
  return ranked;
}

std::array<double, 20> interpolated_precision(const std::vector<bool>& ranked,
                                              std::size_t relevant) {
  std::array<double, 20> result = {};
  std::size_t hits = 0;
  for (std::size_t r = 0; r < ranked.size(); ++r) {
    if (!ranked[r]) continue;
    ++hits;
    const double precision = static_cast<double>(hits) / static_cast<double>(r + 1);
    // In whole numbers: recall hits / relevant reaches level i / 20.
    const std::size_t reached = 20 * hits / relevant;
    for (std::size_t level = 1; level <= reached; ++level) {
      result[level - 1] = std::max(result[level - 1], precision);
    }
  }
  return result;
}

RetrievalScores score(const std::vector<bool>& ranked, std::size_t relevant) {
  const auto c = static_cast<double>(relevant);
  RetrievalScores scores;
  std::size_t hits = 0;
  std::size_t early_hits = 0;
  double ideal = 0.0;
  for (std::size_t r = 0; r < ranked.size(); ++r) {
    if (r < relevant) ideal += gain(r);
    if (!ranked[r]) continue;
    ++hits;
    if (r < relevant) scores.first_tier += 1.0 / c;
    if (r < 2 * relevant) scores.second_tier += 1.0 / c;
    if (r < kEMeasureLength) ++early_hits;
    scores.dcg += gain(r);
    scores.average_precision += static_cast<double>(hits) / static_cast<double>(r + 1) / c;
  }
  scores.precision = interpolated_precision(ranked, relevant);
  scores.nearest = ranked.front() ? 1.0 : 0.0;
  scores.dcg /= ideal;
  if (early_hits > 0) {
    const auto h = static_cast<double>(early_hits);
    const double precision = h / static_cast<double>(std::min(kEMeasureLength, ranked.size()));
    scores.e_measure = 2.0 * precision * (h / c) / (precision + h / c);
  }
  return scores;
}

RetrievalScores score_query(const Eigen::VectorXd& row, const std::vector<std::string>& labels,
                            std::size_t query) {
  std::vector<double> distances;
  std::vector<bool> relevant;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (i == query) continue;
    distances.push_back(row(static_cast<Eigen::Index>(i)));
    relevant.push_back(labels[i] == labels[query]);
  }
  return score_ranking(distances, relevant);
}

std::int64_t count_undefined(const Eigen::VectorXd& row, std::size_t query) {
  std::int64_t count = 0;
  for (Eigen::Index i = 0; i < row.size(); ++i) {
    if (i != static_cast<Eigen::Index>(query) && !std::isfinite(row(i))) ++count;
  }
  return count;
}

}  // namespace

RetrievalScores& RetrievalScores::operator+=(const RetrievalScores& other) {
  nearest += other.nearest;
  first_tier += other.first_tier;
  second_tier += other.second_tier;
  e_measure += other.e_measure;
  dcg += other.dcg;
  average_precision += other.average_precision;
  for (std::size_t i = 0; i < precision.size(); ++i) precision[i] += other.precision[i];
  return *this;
}

RetrievalScores& RetrievalScores::operator/=(double count) {
  nearest /= count;
  first_tier /= count;
  second_tier /= count;
  e_measure /= count;
  dcg /= count;
  average_precision /= count;
  for (double& value : precision) value /= count;
  return *this;
}

RetrievalScores score_ranking(std::span<const double> distances,
                              const std::vector<bool>& relevant) {
  const auto count = std::count(relevant.begin(), relevant.end(), true);
  if (distances.size() != relevant.size() || count == 0) {
    throw Error(ErrorKind::bad_request, "", "ranking",
                "needs one distance per item and at least one relevant item");
  }
  return score(ranked_relevance(distances, relevant), static_cast<std::size_t>(count));
}

RetrievalReport evaluate_retrieval(const std::vector<std::string>& labels,
                                   const std::function<Eigen::VectorXd(Eigen::Index)>& distances) {
  std::map<std::string, std::int64_t> sizes;
  for (const std::string& label : labels) ++sizes[label];
  std::map<std::string, ClassScores> classes;
  RetrievalReport report;
  report.shapes = static_cast<std::int64_t>(labels.size());
  for (std::size_t query = 0; query < labels.size(); ++query) {
    if (labels[query].empty() || sizes[labels[query]] < 2) continue;
    const Eigen::VectorXd row = distances(static_cast<Eigen::Index>(query));
    const RetrievalScores scores = score_query(row, labels, query);
    ClassScores& own = classes[labels[query]];
    own.mean += scores;
    ++own.queries;
    report.micro += scores;
    ++report.queries;
    report.undefined += count_undefined(row, query);
  }
  if (report.queries == 0) {
    throw Error(ErrorKind::bad_request, "", "labels",
                "no two shapes share one; retrieval cannot be measured");
  }
  for (auto& [label, own] : classes) {
    own.label = label;
    own.mean /= static_cast<double>(own.queries);
    report.macro += own.mean;
    report.classes.push_back(own);
  }
  report.micro /= static_cast<double>(report.queries);
  report.macro /= static_cast<double>(report.classes.size());
  return report;
}

}  // namespace timbre
