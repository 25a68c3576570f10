#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "timbre/index/channel.h"
#include "timbre/index/store.h"

namespace timbre {

/// All vectors of one channel in memory, of one state of a database.
class Gallery {
 public:
  explicit Gallery(const Channel& channel) : channel_(&channel) {}

  void add(ShapeInfo shape, const Eigen::VectorXd& vector);

  [[nodiscard]] const Channel& channel() const { return *channel_; }
  [[nodiscard]] std::int64_t size() const { return static_cast<std::int64_t>(shapes_.size()); }
  [[nodiscard]] const ShapeInfo& shape(std::int64_t i) const {
    return shapes_[static_cast<std::size_t>(i)];
  }
  /// The i-th vector in the order of adding; its length depends on the shape.
  [[nodiscard]] std::span<const double> vector(std::int64_t i) const;

  /// Distances from one vector to all.
  [[nodiscard]] Eigen::VectorXd distances(std::span<const double> query) const;

 private:
  const Channel* channel_;
  std::vector<ShapeInfo> shapes_;
  std::vector<double> values_;             // all vectors, end to end
  std::vector<std::size_t> starts_ = {0};  // of each vector, and the end
};

/// @throws Error  what `Store::for_each_descriptor` throws
[[nodiscard]] Gallery load_gallery(const Store& store, const Channel& channel);

struct Neighbor {
  std::int64_t index = 0;  ///< in the gallery
  double distance = 0.0;
};

/// The nearest `count` (0: all) of `candidates`, by distance, then by order of adding;
/// distances that are not finite come last.
[[nodiscard]] std::vector<Neighbor> rank_candidates(const Gallery& gallery,
                                                    std::span<const double> query,
                                                    std::span<const std::int64_t> candidates,
                                                    std::int64_t count);

/// The same over all shapes of the gallery but one; `except` = -1 for none.
[[nodiscard]] std::vector<Neighbor> rank_all(const Gallery& gallery, std::span<const double> query,
                                             std::int64_t count, std::int64_t except = -1);

}  // namespace timbre
