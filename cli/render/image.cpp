#include "timbre/cli/render/image.h"

#include <zlib.h>

#include <cstdlib>

// zlib packs pictures a third smaller than what stb brings along. The writer frees the result.
static unsigned char* pack_with_zlib(unsigned char* data, int size, int* packed, int /*quality*/) {
  uLongf length = compressBound(static_cast<uLong>(size));
  auto* const bytes = static_cast<unsigned char*>(std::malloc(length));
  if (bytes == nullptr) return nullptr;
  if (compress2(bytes, &length, data, static_cast<uLong>(size), Z_BEST_COMPRESSION) != Z_OK) {
    std::free(bytes);
    return nullptr;
  }
  *packed = static_cast<int>(length);
  return bytes;
}

#define STBIW_ZLIB_COMPRESS pack_with_zlib
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
  const std::size_t count = images.size();
  const std::size_t across = std::min(static_cast<std::size_t>(columns), count);
  const std::size_t rows = (count + across - 1) / across;
  const auto height = static_cast<std::size_t>(images.front().height);
  const std::size_t stride = static_cast<std::size_t>(images.front().width) * 4;
  Image all{static_cast<int>(across) * images.front().width, static_cast<int>(rows * height), {}};
  all.rgba.resize(stride * across * height * rows);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t y = 0; y < height; ++y) {
      const std::size_t row = i / across * height + y;
      std::copy_n(&images[i].rgba[y * stride], stride,
                  &all.rgba[(row * across + i % across) * stride]);
    }
  }
  return all;
}

}  // namespace timbre::cli
