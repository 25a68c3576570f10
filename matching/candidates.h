#pragma once

#include <Eigen/Core>
#include <vector>

#include "timbre/matching/surface.h"

namespace timbre {

/// A functional map on the low eigenfunctions that explains both tensors.
struct Candidate {
  Eigen::MatrixXd C;      ///< F(B) -> F(A), (k + 1) x (k + 1), the constants included
  double products = 0.0;  ///< correlation of the product tensors, 1 for an isometry
  double areas = 0.0;     ///< correlation of the area forms: +1 direct, -1 mirrored
  int orientation = 1;    ///< the class it was searched in: +1 direct, -1 mirrored

  [[nodiscard]] double score() const { return products + orientation * areas; }
};

struct CandidateOptions {
  int seed_size = 6;       ///< functions whose order and signs are enumerated
  int displacement = 1;    ///< places a function may move in a seed
  int final_size = 20;     ///< functions of the result
  int kept_seeds = 256;    ///< after scoring
  int kept_polished = 64;  ///< after the first polish
  int kept_grown = 24;     ///< at the end
};

/// Functional maps from A's to B's low eigenfunctions, best first, that carry over the
/// tensors of products and of area forms: every order and sign of the first functions is
/// a seed, polished by polar projection and grown two functions at a time. Rotations
/// within near-equal eigenvalues need no seeds; the projection finds them.
///
/// A map that keeps areas keeps P; any orientation-preserving one keeps O, a mirrored one
/// turns its sign. So nothing here depends on eigenvector signs or on descriptors.
///
/// @param orientation  +1: orientation-preserving maps; -1: mirrored ones
[[nodiscard]] std::vector<Candidate> search_candidates(const MatchSurface& A, const MatchSurface& B,
                                                       int orientation,
                                                       const CandidateOptions& options = {});

/// Keeps the better of candidates that are nearly the same map; sorts best first.
[[nodiscard]] std::vector<Candidate> without_duplicates(std::vector<Candidate> candidates,
                                                        double tolerance, std::size_t cap);

/// Correlation of A's tensor with B's, carried over by C (both without the constant).
[[nodiscard]] double tensor_correlation(const Tensor3& A, const Tensor3& B,
                                        const Eigen::MatrixXd& C);

}  // namespace timbre
