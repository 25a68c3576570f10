#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "timbre/analysis/core/progress.h"
#include "timbre/analysis/mesh/triangle_mesh.h"
#include "timbre/index/channel.h"
#include "timbre/index/store.h"

namespace timbre {

struct QueryOptions {
  std::string channel = kDefaultChannel;
  std::int64_t count = 10;  ///< answers wanted; 0: all, which is always exact
  bool exact = false;       ///< compare with every shape, whatever their number
  /// Below this many shapes every one is compared: a scan of 100,000 vectors takes
  /// milliseconds. From here on candidates come from a `NearestIndex`.
  std::int64_t exact_below = 100000;
  std::function<void(const std::string&)> note = {};  ///< told what the index cache did
  Progress progress = {};                             ///< of solving the query's mesh
  int threads = 0;                                    ///< that solve it, if it is large; 0: all
};

struct QueryResult {
  int rank = 0;  ///< from 1
  std::string name;
  std::string label;  ///< empty: none
  double distance = 0.0;
  /// A probability of being the same kind. No calibration holds for single channels (their
  /// distances depend on how crowded a database is), so it is always empty for now.
  std::optional<double> score;
  std::vector<std::pair<std::string, double>> channels;  ///< distance in each channel used
};

struct QueryAnswer {
  std::vector<QueryResult> results;  ///< nearest first; equal distances in order of adding
  std::int64_t compared = 0;         ///< shapes whose exact distance was computed
  std::int64_t shapes = 0;           ///< shapes in the database
  double recall = 1.0;               ///< of the first ten, as measured on the index; 1: exact scan
};

/// The stored shapes nearest to a mesh, which is solved with the database's parameters.
/// Distances are exact in either way of searching.
/// @throws Error  bad_request for an unknown channel, or one stored with other parameters
[[nodiscard]] QueryAnswer query_mesh(const Store& store, const TriangleMesh& mesh,
                                     const QueryOptions& options = {});

/// The same for a stored shape, which itself is no answer.
/// @throws Error  also bad_request if there is no such shape
[[nodiscard]] QueryAnswer query_stored(const Store& store, const std::string& name,
                                       const QueryOptions& options = {});

}  // namespace timbre
