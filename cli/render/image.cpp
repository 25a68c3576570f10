#include "timbre/cli/render/image.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

#include <algorithm>
#include <new>

namespace timbre::cli {

std::string to_png(const Image& image) {
  std::string bytes;
  const auto append = [](void* to, void* data, int size) {
    static_cast<std::string*>(to)->append(static_cast<const char*>(data),
                                          static_cast<std::size_t>(size));
  };
  if (stbi_write_png_to_func(append, &bytes, image.width, image.height, 4, image.rgba.data(),
                             4 * image.width) == 0) {
    throw std::bad_alloc();
  }
  return bytes;
}

Image tile(const std::vector<Image>& images, int columns) {
  const int count = static_cast<int>(images.size());
  columns = std::min(columns, count);
  const int rows = (count + columns - 1) / columns;
  const int width = images.front().width;
  const int height = images.front().height;
  Image all{columns * width, rows * height, {}};
  const auto stride = static_cast<std::size_t>(width) * 4;
  all.rgba.resize(stride * static_cast<std::size_t>(columns) *
                  static_cast<std::size_t>(all.height));
  for (int i = 0; i < count; ++i) {
    for (int y = 0; y < height; ++y) {
      const auto row = static_cast<std::size_t>(i / columns * height + y);
      const std::size_t to =
          (row * static_cast<std::size_t>(columns) + static_cast<std::size_t>(i % columns)) *
          stride;
      const auto from = images[static_cast<std::size_t>(i)].rgba.begin() +
                        static_cast<std::ptrdiff_t>(static_cast<std::size_t>(y) * stride);
      std::copy_n(from, stride, all.rgba.begin() + static_cast<std::ptrdiff_t>(to));
    }
  }
  return all;
}

}  // namespace timbre::cli
