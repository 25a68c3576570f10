#include "timbre/index/gallery.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace timbre {
namespace {

double finite_or_last(double distance) {
  return std::isfinite(distance) ? distance : std::numeric_limits<double>::infinity();
}

bool comes_before(const Neighbor& a, const Neighbor& b) {
  const double da = finite_or_last(a.distance);
  const double db = finite_or_last(b.distance);
  return da < db || (da == db && a.index < b.index);
}

}  // namespace

void Gallery::add(ShapeInfo shape, const Eigen::VectorXd& vector) {
  shapes_.push_back(std::move(shape));
  values_.insert(values_.end(), vector.begin(), vector.end());
  starts_.push_back(values_.size());
}

std::span<const double> Gallery::vector(std::int64_t i) const {
  const auto at = static_cast<std::size_t>(i);
  return std::span(values_).subspan(starts_[at], starts_[at + 1] - starts_[at]);
}

Eigen::VectorXd Gallery::distances(std::span<const double> query) const {
  Eigen::VectorXd row(size());
  for (std::int64_t i = 0; i < size(); ++i) row(i) = channel_->distance(query, vector(i));
  return row;
}

Gallery load_gallery(const Store& store, const Channel& channel) {
  Gallery gallery(channel);
  store.for_each_descriptor(channel, [&](const ShapeInfo& shape, const Eigen::VectorXd& vector) {
    gallery.add(shape, vector);
  });
  return gallery;
}

std::vector<Neighbor> rank_candidates(const Gallery& gallery, std::span<const double> query,
                                      std::span<const std::int64_t> candidates,
                                      std::int64_t count) {
  std::vector<Neighbor> ranked;
  ranked.reserve(candidates.size());
  for (const std::int64_t i : candidates) {
    ranked.push_back({i, gallery.channel().distance(query, gallery.vector(i))});
  }
  const auto size = static_cast<std::int64_t>(ranked.size());
  const std::int64_t wanted = count > 0 ? std::min(count, size) : size;
  std::partial_sort(ranked.begin(), ranked.begin() + wanted, ranked.end(), comes_before);
  ranked.resize(static_cast<std::size_t>(wanted));
  return ranked;
}

std::vector<Neighbor> rank_all(const Gallery& gallery, std::span<const double> query,
                               std::int64_t count, std::int64_t except) {
  std::vector<std::int64_t> all(static_cast<std::size_t>(gallery.size()));
  std::iota(all.begin(), all.end(), std::int64_t{0});
  if (except >= 0) all.erase(all.begin() + except);
  return rank_candidates(gallery, query, all, count);
}

}  // namespace timbre
