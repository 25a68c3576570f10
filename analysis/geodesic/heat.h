#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre {

struct HeatOptions {
  /// Heat spreads for this many squares of the mean edge length. More is smoother and rounds
  /// off the lines where fronts meet; less is nearer the truth on even meshes, and noise on
  /// uneven ones. From 0.01 to 1e6.
  double time_factor = 1.0;
};

/// Approximate distances by the heat method: a short flow of heat from the source tells the
/// direction of the gradient everywhere, and a Poisson equation the distance.
///
/// Factorises two matrices once; each source then costs two solutions, far less than an exact
/// run on a large mesh. Mean error 0.5 to 2 % on even meshes; more on meshes of very unlike
/// triangles. Not zero at neighbours of coincident vertices, nor monotonous: where exactness
/// matters, use `ExactGeodesics`.
///
/// Any triangle mesh whose components have an area. Triangles without area carry no distance.
/// Components are solved apart. One call at a time.
///
/// @see Crane, Weischedel and Wardetzky 2013; `compute_operator` for the matrices
class HeatGeodesics {
 public:
  /// @throws Error  bad_input as `compute_operator`; bad_request for a bad `time_factor`
  explicit HeatGeodesics(const TriangleMesh& mesh, const HeatOptions& options = {});
  ~HeatGeodesics();
  HeatGeodesics(HeatGeodesics&&) noexcept;
  HeatGeodesics& operator=(HeatGeodesics&&) noexcept;

  /// n, distance of every vertex to the nearest of `sources`, which are 0; infinite on
  /// components without a source.
  /// @throws Error  bad_request for a source that is no vertex; not_converged where a vertex
  ///                is so many edges away that no heat of a double's range arrives
  [[nodiscard]] Eigen::VectorXd distances(std::span<const std::int32_t> sources);

  /// n x s, one column for each set of sources.
  /// @param threads  0: all cores; the result does not depend on it
  [[nodiscard]] Eigen::MatrixXd distances(std::span<const std::vector<std::int32_t>> source_sets,
                                          int threads);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace timbre
