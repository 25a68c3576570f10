#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "timbre/index/gallery.h"

namespace timbre {

/// Finds candidates for the nearest vectors of a gallery without looking at all: a tree of
/// k-means clusters (FLANN), searched by Euclidean distance in single precision. Callers
/// rank the candidates by the channel's own distance.
///
/// Building draws from a fixed seed: the same vectors give the same tree. Shapes whose
/// vector is shorter than the longest are no part of the tree; they are always candidates.
/// Searching is thread-safe.
/// @see Muja and Lowe 2014
class NearestIndex {
 public:
  /// Also measures the recall. Cost for 100,000 vectors of 100 entries: some seconds.
  explicit NearestIndex(const Gallery& gallery);
  ~NearestIndex();
  NearestIndex(NearestIndex&&) noexcept;
  NearestIndex& operator=(NearestIndex&&) noexcept;

  /// Indices into the gallery, in no particular order.
  [[nodiscard]] std::vector<std::int64_t> candidates(std::span<const double> query,
                                                     std::int64_t count) const;

  /// Share of the true first ten found among 500 candidates, by the channel's distance,
  /// over up to 200 vectors of the gallery as queries; 1 for an empty one.
  [[nodiscard]] double recall() const;

  /// The whole index as bytes: a header, FLANN's tree, a SHA-256 over both.
  [[nodiscard]] std::string to_bytes() const;
  /// Empty unless the bytes are whole and were made of these very vectors.
  [[nodiscard]] static std::optional<NearestIndex> from_bytes(const Gallery& gallery,
                                                              std::string_view bytes);

 private:
  struct Impl;
  explicit NearestIndex(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Where the index of a database is kept: `DATABASE.CHANNEL.index`.
[[nodiscard]] std::string nearest_cache_path(const std::string& location, const Channel& channel);

/// Loads the index kept at `path`, or builds it and keeps it there. It is a cache: absent,
/// old or damaged files are replaced, and where none can be written it works without.
/// @param note  told in one line what was rebuilt or could not be kept; may be empty
[[nodiscard]] NearestIndex open_nearest(const Gallery& gallery, const std::string& path,
                                        const std::function<void(const std::string&)>& note);

}  // namespace timbre
