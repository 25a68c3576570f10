#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "timbre/analysis/core/progress.h"
#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre {

enum class DistanceMethod : std::uint8_t {
  exact,  ///< `ExactGeodesics`
  heat,   ///< `HeatGeodesics`
  graph,  ///< `graph_distances`
};

struct DistanceOptions {
  DistanceMethod method = DistanceMethod::exact;
  double time_factor = 1.0;  ///< of the heat method; see `HeatOptions`
  int threads = 0;           ///< 0: all cores; the result does not depend on it
  Progress progress = {};    ///< may be empty
};

/// Takes the next columns: n x b, for the source sets from `first` on.
using DistanceSink =
    std::function<void(Eigen::Index first, const Eigen::Ref<const Eigen::MatrixXd>& columns)>;

/// Distances of all vertices to the nearest vertex of each source set, handed over in blocks of
/// columns, in order, on the caller's thread. Memory is bounded: a block is at most 64 MiB, or
/// a column for each thread.
///
/// Distances are infinite where a set does not reach, and throughout for an empty one.
/// @throws Error  bad_request for a source that is no vertex, before any work; what the method
///                throws; cancelled
void compute_distances(const TriangleMesh& mesh,
                       std::span<const std::vector<std::int32_t>> source_sets,
                       const DistanceSink& sink, const DistanceOptions& options = {});

/// The same in one matrix, n x s.
[[nodiscard]] Eigen::MatrixXd compute_distances(
    const TriangleMesh& mesh, std::span<const std::vector<std::int32_t>> source_sets,
    const DistanceOptions& options = {});

/// `exact`, `heat` or `graph`: the words of the command line.
[[nodiscard]] const char* to_word(DistanceMethod method);

}  // namespace timbre
