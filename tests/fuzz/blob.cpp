// Stored blobs: a mesh or numbers, sound and of the size their row says, or one line.
#include <zstd.h>

#include <string>

#include "timbre/index/detail/records.h"
#include "timbre/index/detail/text.h"
#include "timbre/tests/fuzz/memory_watch.h"
#include "timbre/tests/fuzz/target.h"

namespace timbre::fuzz {
namespace {

void examine_mesh(std::string_view bytes, std::int64_t vertices, std::int64_t faces) {
  try {
    const TriangleMesh mesh = detail::unpack_mesh(bytes, vertices, faces);
    require(mesh.vertices.rows() == vertices && mesh.faces.rows() == faces,
            "a mesh has the size its row says");
    require(mesh.vertices.allFinite(), "coordinates are finite");
    require(faces == 0 || (mesh.faces.minCoeff() >= 0 && mesh.faces.maxCoeff() < vertices),
            "indices are in range");
    const TriangleMesh back = detail::unpack_mesh(detail::pack_mesh(mesh), vertices, faces);
    require(back.vertices == mesh.vertices && back.faces == mesh.faces,
            "what is packed is unpacked");
  } catch (const Error& error) {
    require_plain(error, ErrorKind::bad_input);
  }
}

std::string packed(std::string_view plain) {
  std::string bytes(ZSTD_compressBound(plain.size()), '\0');
  bytes.resize(ZSTD_compress(bytes.data(), bytes.size(), plain.data(), plain.size(), 1));
  return bytes;
}

}  // namespace

void examine(std::string_view input) {
  (void)detail::is_utf8(input);
  const Eigen::VectorXd numbers = detail::unpack_numbers(input);
  require(detail::pack_numbers(numbers) == input.substr(0, input.size() / 8 * 8),
          "numbers are what lies there");

  Draw draw(input);
  const std::int64_t vertices = draw.take<std::int32_t>();
  const std::int64_t faces = draw.take<std::int32_t>();
  examine_mesh(draw.rest(), vertices, faces);  // as it would be in a damaged file

  // The same bytes as the content of a whole frame.
  const std::int64_t rows = static_cast<std::int64_t>(draw.rest().size()) / 12;
  const std::int64_t points = vertices < 0 ? 0 : vertices % (rows / 2 + 1);
  const std::int64_t triangles = rows - 2 * points;
  examine_mesh(packed(draw.rest().substr(0, static_cast<std::size_t>(12 * rows))), points,
               triangles);
}

}  // namespace timbre::fuzz
