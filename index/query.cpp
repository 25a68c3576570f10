#include "timbre/index/query.h"

#include <algorithm>
#include <utility>

#include "timbre/analysis/core/error.h"
#include "timbre/index/features.h"
#include "timbre/index/gallery.h"
#include "timbre/index/nearest.h"

namespace timbre {
namespace {

constexpr std::int64_t kCandidates = 500;

std::vector<Neighbor> search(const Store& store, const Gallery& gallery,
                             std::span<const double> query, std::int64_t except,
                             const QueryOptions& options, QueryAnswer& answer) {
  answer.shapes = gallery.size();
  const bool scan = options.exact || options.count == 0 || gallery.size() < options.exact_below;
  if (scan) {
    answer.compared = gallery.size() - (except >= 0 ? 1 : 0);
    return rank_all(gallery, query, options.count, except);
  }
  const NearestIndex index =
      open_nearest(gallery, nearest_cache_path(store.location(), gallery.channel()), options.note);
  std::vector<std::int64_t> candidates =
      index.candidates(query, std::max(kCandidates, 5 * options.count));
  std::erase(candidates, except);
  answer.compared = static_cast<std::int64_t>(candidates.size());
  answer.recall = index.recall();
  return rank_candidates(gallery, query, candidates, options.count);
}

QueryAnswer answer_from(const Store& store, const Gallery& gallery, std::span<const double> query,
                        std::int64_t except, const QueryOptions& options) {
  QueryAnswer answer;
  for (const Neighbor& near : search(store, gallery, query, except, options, answer)) {
    const ShapeInfo& shape = gallery.shape(near.index);
    answer.results.push_back({static_cast<int>(answer.results.size()) + 1,
                              shape.name,
                              shape.label,
                              near.distance,
                              std::nullopt,
                              {{gallery.channel().name, near.distance}}});
  }
  return answer;
}

}  // namespace

QueryAnswer query_mesh(const Store& store, const TriangleMesh& mesh, const QueryOptions& options) {
  const Channel& channel = find_channel(options.channel);
  const Gallery gallery = load_gallery(store, channel);
  const Eigen::VectorXd query = channel.compute(
      compute_features(mesh, store.parameters(), options.progress, options.threads));
  return answer_from(store, gallery,
                     std::span(query.data(), static_cast<std::size_t>(query.size())), -1, options);
}

QueryAnswer query_stored(const Store& store, const std::string& name, const QueryOptions& options) {
  const Gallery gallery = load_gallery(store, find_channel(options.channel));
  for (std::int64_t i = 0; i < gallery.size(); ++i) {
    if (gallery.shape(i).name != name) continue;
    return answer_from(store, gallery, gallery.vector(i), i, options);
  }
  throw Error(ErrorKind::bad_request, store.location(), "", "there is no shape '" + name + "'");
}

}  // namespace timbre
