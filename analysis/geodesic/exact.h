#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "timbre/analysis/geodesic/geodesic_mesh.h"

namespace timbre {

struct ExactOptions {
  /// Only the distances of these are wanted, all others are left infinite; empty: all vertices.
  /// Near ones are found at once, and far ones by looking only where the way may lead.
  std::vector<std::int32_t> targets = {};
  /// Farther vertices are infinite; in the mesh's unit, at least 0.
  double limit = std::numeric_limits<double>::infinity();
  /// Asked now and then, on the thread of the call; false stops it. May be empty.
  std::function<bool()> keep_going = {};
};

/// Exact distances on the surface made of the mesh's flat triangles.
///
/// Shortest paths cross edges as straight lines of the unfolded triangles and bend at saddle,
/// boundary and non-manifold vertices only. Any triangle mesh: where more than two triangles
/// meet at an edge, paths go on into each of them.
///
/// Holds the workspace of its runs, so that a run costs no more than the part of the mesh
/// that it passes: near targets are cheap on a mesh of any size. One call at a time; use one
/// object per thread.
///
/// @see Mitchell, Mount and Papadimitriou 1987; Surazhsky et al. 2005; Xin and Wang 2009
class ExactGeodesics {
 public:
  /// @param mesh  must outlive the object
  explicit ExactGeodesics(const GeodesicMesh& mesh);
  ~ExactGeodesics();
  ExactGeodesics(ExactGeodesics&&) noexcept;
  ExactGeodesics& operator=(ExactGeodesics&&) noexcept;

  /// n, distance of every vertex to the nearest of `sources` (all 0 apart from each other);
  /// infinite where none is reached. Never above `graph_distances`, but for rounding.
  /// @throws Error  bad_request for a source or target that is no vertex, or a bad limit;
  ///                cancelled
  [[nodiscard]] Eigen::VectorXd distances(std::span<const std::int32_t> sources,
                                          const ExactOptions& options = {});

  /// Only the distances of `targets`, in their order.
  /// @throws Error  as above
  [[nodiscard]] std::vector<double> distances_to(
      std::span<const std::int32_t> sources, std::span<const std::int32_t> targets,
      double limit = std::numeric_limits<double>::infinity());

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// One run of `ExactGeodesics`.
[[nodiscard]] Eigen::VectorXd exact_distances(const GeodesicMesh& mesh,
                                              const std::vector<std::int32_t>& sources,
                                              const ExactOptions& options = {});

}  // namespace timbre
