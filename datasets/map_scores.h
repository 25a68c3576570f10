#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "timbre/analysis/core/progress.h"
#include "timbre/analysis/mesh/triangle_mesh.h"
#include "timbre/datasets/truth.h"

namespace timbre {

enum class GeodesicKind : std::uint8_t {
  exact,  ///< on the flat triangles
  graph,  ///< along edges and unfolded diagonals, about 2 % longer
};

/// Distances on a surface that errors are measured by, in units of the square root of its
/// area, times 100: 100 is about the size of the shape.
class ErrorScale {
 public:
  /// @throws Error  bad_input if the mesh has no area
  ErrorScale(const TriangleMesh& mesh, GeodesicKind kind);
  ~ErrorScale();
  ErrorScale(ErrorScale&&) noexcept;
  ErrorScale& operator=(ErrorScale&&) noexcept;

  /// The distance from each `from` to its `to`; 100 between components.
  /// @param threads  0: all cores; the result does not depend on it
  /// @throws Error  bad_request for what is no vertex; cancelled
  [[nodiscard]] std::vector<double> between(std::span<const std::int32_t> from,
                                            std::span<const std::int32_t> to, int threads,
                                            const Progress& progress = {}) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// How right a map is.
struct MapScore {
  double mean_error = 0.0;  ///< over the rows answered; NaN if none is
  double below5 = 0.0;      ///< share of the rows answered with an error of at most 5
  double matched = 0.0;     ///< share of the rows answered
  bool found = false;       ///< mean below 5 and enough rows answered
  /// All rows answered: errors, in the order of the truth.
  std::vector<double> errors;
  std::int64_t rows = 0;

  /// Share of all rows with an error of at most `error`; the PCK curve.
  [[nodiscard]] double share_below(double error) const;
};

/// @param map  an image for each vertex of the source, -1 = unmatched
/// @throws Error  bad_request if the map is too short for the truth or leads to no vertex;
/// cancelled
/// @see Kim, Lipman and Funkhouser 2011, section 8 (curves of errors)
[[nodiscard]] MapScore score_map(const std::vector<std::int32_t>& map, const Truth& truth,
                                 const ErrorScale& scale, int threads,
                                 const Progress& progress = {});

/// A symmetry counts a row as right within sqrt(area / (20 pi)), and itself where more than
/// three quarters of the rows count.
/// @see Kim, Lipman, Chen and Funkhouser 2010
inline constexpr double kSymmetryError = 12.615662610100802;  // 100 / sqrt(20 pi)
inline constexpr double kSymmetryShare = 0.75;

}  // namespace timbre
