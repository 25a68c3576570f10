#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace timbre::cli {

/// Pixels from the top left, row by row; red, green, blue and alpha in sRGB, the colours
/// not multiplied by alpha.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;  ///< 4 width height
};

/// The bytes of a PNG file.
[[nodiscard]] std::string to_png(const Image& image);

/// Pictures of one size side by side, row by row from the top left, `columns` in a row;
/// the rest of the last row is transparent.
[[nodiscard]] Image tile(const std::vector<Image>& images, int columns);

}  // namespace timbre::cli
