#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "timbre/analysis/spectrum/spectrum.h"

namespace timbre {

enum class EmbeddingKind : std::uint8_t {
  gps,         ///< phi_i / sqrt(lambda_i): squared distances are Green's function's
  diffusion,   ///< e^(-lambda_i t) phi_i: heat exchanged in time t
  biharmonic,  ///< phi_i / lambda_i: smooth near the source, aware of shape afar
};

struct EmbeddingOptions {
  EmbeddingKind kind = EmbeddingKind::gps;
  int dimensions = 0;  ///< coordinates wanted; 0: all the spectrum gives
  double time = 0.05;  ///< diffusion only; positive; in units of area, .05 suits unit area
};

/// Maps the surface into a Euclidean space whose distances know the shape's
/// conductivity: row x holds the coordinates of vertex x. All zero eigenvalues are left
/// out, so points of different components are told apart by nothing but their own
/// component's eigenfunctions.
///
/// Distances between rows do not see signs of eigenvectors nor rotations inside an
/// eigenspace, except in one that the last dimension cuts. Coordinates do.
/// Pass `at_unit_area(...)` to be blind to scale.
///
/// @return n x d; d is less than `dimensions` where the spectrum is shorter
/// @throws Error  bad_request if all eigenvalues are zero or an option is out of range
/// @see Rustamov 2007 (gps); Coifman and Lafon 2006 (diffusion); Lipman et al. 2010
[[nodiscard]] Eigen::MatrixXd compute_embedding(const Spectrum& spectrum,
                                                const EmbeddingOptions& options = {});

}  // namespace timbre
