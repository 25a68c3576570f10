#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "timbre/analysis/core/progress.h"
#include "timbre/analysis/operators/operator.h"
#include "timbre/analysis/spectrum/factorization.h"

namespace timbre {

struct SpectrumOptions {
  int count = 100;  ///< eigenpairs wanted, from the lowest; capped at n
  /// Largest residual accepted, as `residuals` measures it. The solver aims a thousand times lower;
  /// eigenvectors are accepted if orthonormal to a hundredth of it, or to 1e-8.
  double tolerance = 1e-6;
  bool certify = true;  ///< count eigenvalues at the end of the list, so that none is missing
  FactorizationBackend backend = FactorizationBackend::automatic;
  int threads = 0;         ///< that work on one mesh, if it is large; 0: all cores
  Progress progress = {};  ///< may be empty
};

/// How many eigenvalues of one connected component lie below a shift, by Sylvester's law of
/// inertia: the negative pivots of a factorisation of `W - shift M`.
struct InertiaCount {
  int component = 0;
  double shift = 0.0;  ///< 1/length^2
  std::int64_t below = 0;
  int pairs = 0;  ///< that were computed around this shift
};

/// A proof by counting: exactly `count` eigenvalues of the computed matrices lie below
/// `bound`. The count is at least the number of pairs returned; it is larger where the
/// last pair belongs to a cluster that goes on.
struct Certificate {
  double bound = 0.0;                ///< 1/length^2
  std::int64_t count = 0;            ///< eigenvalues below
  std::vector<InertiaCount> shifts;  ///< of each component that was not solved densely
};

/// Seconds of wall time by what was done.
struct SpectrumPhases {
  double ordering = 0.0;           ///< of unknowns, and the structure of the factor
  double factorization = 0.0;      ///< at all shifts, with a check of each
  double solves = 0.0;             ///< with the factors
  double orthogonalization = 0.0;  ///< of Lanczos vectors
  double projection = 0.0;         ///< the small eigenproblems
  double vectors = 0.0;            ///< from the basis to the eigenvectors
  double checks = 0.0;             ///< residuals and orthonormality
};

/// The lowest eigenpairs of `W phi = lambda M phi`. Always checked: whoever holds a
/// Spectrum may rely on `residuals`, and on `certificate` where it is not empty.
struct Spectrum {
  Eigen::VectorXd values;     ///< k, ascending, 1/length^2; exact zeros are 0
  Eigen::MatrixXd vectors;    ///< N x k, M-orthonormal, column i for values(i)
  Eigen::VectorXd residuals;  ///< k, relative, dimensionless
  /// max |Phi^T M Phi - I|: over all pairs up to about a hundred, of more over those found together
  /// and next to each other, and for the others by random sums.
  double orthonormality = 0.0;
  int zeros = 0;  ///< leading eigenvalues that are exactly 0: `count_zeros`
  std::optional<Certificate> certificate;  ///< empty if not asked for
  SpectrumPhases phases;                   ///< since the start, or since `SpectrumStream::resume`
};

/// Computes the `options.count` lowest eigenpairs of a Laplacian.
///
/// Each connected component is solved alone, at unit area; the result is the merged
/// union, and an eigenfunction lives on one component. The result does not depend on
/// the number of threads. The sign of a column is canonical (the first entry, in vertex
/// order, above half the largest is positive) but means nothing: use it for display,
/// never in an algorithm. On rows without part, as vertices in no triangle, eigenfunctions are 0.
///
/// @param op  as `compute_operator` makes it
/// @throws Error  bad_request if count < 1; not_converged if a pair misses `tolerance`
///                or the inertia counts cannot be met, after retries; cancelled
/// @see Vallet and Levy 2008, section 4 (shift-invert, band by band); Ericsson and Ruhe 1980
[[nodiscard]] Spectrum compute_spectrum(const Operator& op, const SpectrumOptions& options = {});

/// Bytes that `compute_spectrum` will take at most for most meshes, by their size alone.
/// @param rows   of the matrices
/// @param count  of eigenpairs
[[nodiscard]] std::int64_t expected_memory(Eigen::Index rows, int count);

/// The same spectrum as of the surface scaled to unit total area: values times the
/// area, vectors times its square root.
/// @param area  total area of the operator the spectrum came from
[[nodiscard]] Spectrum at_unit_area(Spectrum spectrum, double area);

/// The same with the rows of vertices only, where `p2` and `p3` have further nodes.
[[nodiscard]] Spectrum at_vertices(Spectrum spectrum, const Operator& op);

}  // namespace timbre
