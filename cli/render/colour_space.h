#pragma once

#include <Eigen/Core>

namespace timbre::cli {

/// Red, green and blue in [0, 1]; each use says whether in sRGB or linear in light.
using Colour = Eigen::Vector3f;

[[nodiscard]] Colour to_linear(const Colour& srgb);
[[nodiscard]] Colour to_srgb(const Colour& linear);

/// CIE lightness L* of an sRGB colour, 0 (black) to 100 (white).
[[nodiscard]] double lightness_of(const Colour& srgb);

/// The sRGB colour of a given CIE lightness whose chroma and hue (degrees) in OKLab are as
/// asked; where the screen cannot show so much chroma, of less chroma.
/// @see Ottosson 2020 (OKLab)
[[nodiscard]] Colour colour_of(double lightness, double chroma, double hue);

/// Perceptual coordinates (OKLab) of an sRGB colour; distances say how unlike colours look.
[[nodiscard]] Eigen::Vector3d to_oklab(const Colour& srgb);

}  // namespace timbre::cli
