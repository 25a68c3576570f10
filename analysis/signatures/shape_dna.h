#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "timbre/analysis/spectrum/spectrum.h"

namespace timbre {

/// How an eigenvalue enters a descriptor. The forms differ in what they listen to:
/// `weighted` and `per_index` to the low end (kinds of things), `logarithm` and
/// `weyl` to all of it (one individual in many poses).
enum class ShapeDnaForm : std::uint8_t {
  plain,      ///< lambda_i
  logarithm,  ///< log(lambda_i + 1e-3); the shift keeps zeros of further components finite
  per_index,  ///< lambda_i / i
  weyl,       ///< lambda_i / (4 pi i), which tends to 1 at unit area (Weyl's law)
  weighted,   ///< 100 / (lambda_i + 5), a weighted spectral distance
};

/// The lowest eigenvalues as a descriptor: entry i - 1 comes from lambda_i.
///
/// lambda_0 = 0 says nothing and is left out. Zeros beyond it count the components
/// and stay. Eigenvalues are taken as they are: pass `at_unit_area(spectrum, area)`
/// for a descriptor that does not see scale, as all forms but `plain` assume.
///
/// @param count  entries wanted; fewer come back where the spectrum is shorter
/// @throws Error  bad_request if count < 1 or the spectrum holds lambda_0 alone
/// @see Reuter, Wolter and Peinecke 2006; Konukoglu et al. 2013 (weighted distance)
[[nodiscard]] Eigen::VectorXd compute_shape_dna(const Spectrum& spectrum, ShapeDnaForm form,
                                                int count = 100);

}  // namespace timbre
