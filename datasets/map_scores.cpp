#include "timbre/datasets/map_scores.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/threads.h"
#include "timbre/analysis/geodesic/exact.h"
#include "timbre/analysis/geodesic/graph.h"
#include "timbre/analysis/mesh/diagnosis.h"

namespace timbre {
namespace {

constexpr double kFound = 5.0;
constexpr double kUnreached = 100.0;

// The rows of one `to`: distances from a single source.
struct Group {
  std::int32_t to = 0;
  std::vector<std::size_t> rows;
  std::vector<std::int32_t> from;
};

std::vector<Group> group_by_target(std::span<const std::int32_t> from,
                                   std::span<const std::int32_t> to) {
  std::vector<std::size_t> order(to.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return to[a] < to[b]; });
  std::vector<Group> groups;
  for (const std::size_t row : order) {
    if (groups.empty() || groups.back().to != to[row]) groups.push_back({to[row], {}, {}});
    groups.back().rows.push_back(row);
    groups.back().from.push_back(from[row]);
  }
  return groups;
}

void require_vertices(std::span<const std::int32_t> from, std::span<const std::int32_t> to,
                      std::int64_t vertices) {
  if (from.size() != to.size()) {
    throw Error(ErrorKind::bad_request, "", "distances",
                "want as many ends as starts, not " + std::to_string(to.size()) + " and " +
                    std::to_string(from.size()));
  }
  for (const auto& list : {from, to}) {
    for (const std::int32_t v : list) {
      if (v >= 0 && v < vertices) continue;
      throw Error(ErrorKind::bad_request, "", "distances",
                  std::to_string(v) + " is no vertex; the mesh has " + std::to_string(vertices) +
                      ", from 0");
    }
  }
}

double count_below(const std::vector<double>& errors, double bar) {
  return static_cast<double>(
      std::count_if(errors.begin(), errors.end(), [&](double one) { return one <= bar; }));
}

}  // namespace

struct ErrorScale::Impl {
  GeodesicKind kind = GeodesicKind::exact;
  double unit = 1.0;  // hundredths of the square root of the area
  std::int64_t vertices = 0;
  GeodesicMesh mesh;

  [[nodiscard]] std::vector<double> measure(ExactGeodesics& exact, const Group& group) const {
    const std::int32_t source = group.to;
    if (kind == GeodesicKind::exact) return exact.distances_to({&source, 1}, group.from);
    const Eigen::VectorXd all = graph_distances(mesh.graph, {source}) * mesh.unit;
    std::vector<double> found;
    found.reserve(group.from.size());
    for (const std::int32_t v : group.from) found.push_back(all[v]);
    return found;
  }
};

ErrorScale::ErrorScale(const TriangleMesh& mesh, GeodesicKind kind)
    : impl_(std::make_unique<Impl>()) {
  const double area = diagnose(mesh).area;
  if (!(area > 0.0) || !std::isfinite(area)) {
    throw Error(ErrorKind::bad_input, "", "area", "is 0 or beyond a double's range");
  }
  impl_->kind = kind;
  impl_->vertices = mesh.vertices.rows();
  impl_->unit = std::sqrt(area) / 100.0;
  impl_->mesh = make_geodesic_mesh(mesh);
}

ErrorScale::~ErrorScale() = default;
ErrorScale::ErrorScale(ErrorScale&&) noexcept = default;
ErrorScale& ErrorScale::operator=(ErrorScale&&) noexcept = default;

std::vector<double> ErrorScale::between(std::span<const std::int32_t> from,
                                        std::span<const std::int32_t> to, int threads,
                                        const Progress& progress) const {
  constexpr std::size_t kBlock = 64;  // groups that share a workspace
  require_vertices(from, to, impl_->vertices);
  const std::vector<Group> groups = group_by_target(from, to);
  std::vector<double> result(from.size());
  const auto blocks = static_cast<std::int64_t>((groups.size() + kBlock - 1) / kBlock);
  SharedProgress shared(progress, "judging", std::ssize(groups));
  parallel_for(blocks, threads, [&](std::int64_t block) {
    ExactGeodesics exact(impl_->mesh);
    const std::size_t begin = static_cast<std::size_t>(block) * kBlock;
    for (std::size_t g = begin; g < std::min(begin + kBlock, groups.size()); ++g) {
      const std::vector<double> distances = impl_->measure(exact, groups[g]);
      for (std::size_t i = 0; i < distances.size(); ++i) {
        result[groups[g].rows[i]] =
            std::isfinite(distances[i]) ? distances[i] / impl_->unit : kUnreached;
      }
      shared.finish_one();
    }
  });
  return result;
}

double MapScore::share_below(double error) const {
  return rows == 0 ? 0.0 : count_below(errors, error) / static_cast<double>(rows);
}

MapScore score_map(const std::vector<std::int32_t>& map, const Truth& truth,
                   const ErrorScale& scale, int threads, const Progress& progress) {
  std::vector<std::int32_t> image;
  std::vector<std::int32_t> right;
  for (std::size_t i = 0; i < truth.source.size(); ++i) {
    const auto v = static_cast<std::size_t>(truth.source[i]);
    if (v >= map.size()) {
      throw Error(ErrorKind::bad_request, "", "map",
                  "has " + std::to_string(map.size()) + " entries; the truth asks for vertex " +
                      std::to_string(v));
    }
    if (map[v] < 0) continue;
    image.push_back(map[v]);
    right.push_back(truth.target[i]);
  }
  MapScore score;
  score.rows = static_cast<std::int64_t>(truth.source.size());
  score.errors = scale.between(image, right, threads, progress);
  const auto answered = static_cast<double>(image.size());
  score.matched = truth.source.empty() ? 0.0 : answered / static_cast<double>(score.rows);
  score.mean_error =
      image.empty() ? std::numeric_limits<double>::quiet_NaN()
                    : std::accumulate(score.errors.begin(), score.errors.end(), 0.0) / answered;
  if (!image.empty()) score.below5 = count_below(score.errors, kFound) / answered;
  score.found = score.mean_error < kFound && score.matched >= (truth.partial ? 0.9 : 1.0);
  return score;
}

}  // namespace timbre
