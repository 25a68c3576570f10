#include "timbre/index/detail/records.h"

#include <zstd.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "timbre/analysis/core/error.h"

namespace timbre {

Sha256Digest content_of(const TriangleMesh& mesh) {
  const auto bytes = [](const auto& array) {
    return std::string_view(reinterpret_cast<const char*>(array.data()),
                            static_cast<std::size_t>(array.size()) * sizeof(*array.data()));
  };
  Sha256 hash;
  hash.add_text("timbre mesh 1");
  hash.add_text(bytes(mesh.vertices));
  hash.add_text(bytes(mesh.faces));
  return hash.finish();
}

namespace detail {
namespace {

static_assert(std::endian::native == std::endian::little, "blobs are stored as they lie");

constexpr int kCompressionLevel = 3;

std::string real_bits(double value) { return std::to_string(std::bit_cast<std::uint64_t>(value)); }

// memcpy must not be given the null of an empty array, not even to copy nothing.
void copy_bytes(void* to, const void* from, std::size_t count) {
  if (count > 0) std::memcpy(to, from, count);
}

// A checksum shows damage, not what a program other than ours may have put there.
void require_sound(const TriangleMesh& mesh) {
  const auto refuse = [](const char* cause) {
    throw Error(ErrorKind::bad_input, "", "mesh", cause);
  };
  if (!mesh.vertices.allFinite()) refuse("holds a coordinate that is not finite");
  if (mesh.faces.size() == 0) return;
  if (mesh.faces.minCoeff() < 0 || mesh.faces.maxCoeff() >= mesh.vertices.rows()) {
    refuse("holds a corner that is no vertex");
  }
}

}  // namespace

std::string pack_mesh(const TriangleMesh& mesh) {
  const std::size_t points = static_cast<std::size_t>(mesh.vertices.size()) * sizeof(double);
  const std::size_t corners = static_cast<std::size_t>(mesh.faces.size()) * sizeof(std::int32_t);
  std::string plain(points + corners, '\0');
  copy_bytes(plain.data(), mesh.vertices.data(), points);
  copy_bytes(plain.data() + points, mesh.faces.data(), corners);
  std::string packed(ZSTD_compressBound(plain.size()), '\0');
  const std::size_t size =
      ZSTD_compress(packed.data(), packed.size(), plain.data(), plain.size(), kCompressionLevel);
  if (ZSTD_isError(size) != 0U) {
    throw Error(ErrorKind::io, "", "mesh", ZSTD_getErrorName(size));
  }
  packed.resize(size);
  return packed;
}

TriangleMesh unpack_mesh(std::string_view bytes, std::int64_t vertices, std::int64_t faces) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  const Error broken(ErrorKind::bad_input, "", "mesh", "does not have the size its shape says");
  if (vertices < 0 || vertices > kMost || faces < 0 || faces > kMost) throw broken;
  const std::size_t points = static_cast<std::size_t>(vertices) * 3 * sizeof(double);
  const std::size_t corners = static_cast<std::size_t>(faces) * 3 * sizeof(std::int32_t);
  // Before memory is asked for: a file must not choose how much.
  if (ZSTD_getFrameContentSize(bytes.data(), bytes.size()) != points + corners) throw broken;
  std::string plain(points + corners, '\0');
  if (ZSTD_decompress(plain.data(), plain.size(), bytes.data(), bytes.size()) != plain.size()) {
    throw broken;
  }
  TriangleMesh mesh;
  mesh.vertices.resize(vertices, 3);
  mesh.faces.resize(faces, 3);
  copy_bytes(mesh.vertices.data(), plain.data(), points);
  copy_bytes(mesh.faces.data(), plain.data() + points, corners);
  require_sound(mesh);
  return mesh;
}

std::string pack_numbers(const Eigen::VectorXd& values) {
  std::string bytes(static_cast<std::size_t>(values.size()) * sizeof(double), '\0');
  copy_bytes(bytes.data(), values.data(), bytes.size());
  return bytes;
}

Eigen::VectorXd unpack_numbers(std::string_view bytes) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(bytes.size() / sizeof(double)));
  copy_bytes(values.data(), bytes.data(), bytes.size() / sizeof(double) * sizeof(double));
  return values;
}

Sha256Digest digest_of_meta(std::string_view key, std::string_view value) {
  Sha256 hash;
  hash.add_text("timbre meta 1");
  hash.add_text(key);
  hash.add_text(value);
  return hash.finish();
}

Sha256Digest digest_of_shape(const ShapeInfo& shape, std::int64_t blobs) {
  Sha256 hash;
  hash.add_text("timbre shape 1");
  hash.add_text(std::to_string(shape.id));
  hash.add_text(shape.name);
  hash.add_text(shape.label);
  hash.add_bytes(as_blob(shape.content));
  hash.add_text(std::to_string(shape.vertices));
  hash.add_text(std::to_string(shape.faces));
  hash.add_text(real_bits(shape.area));
  hash.add_text(std::to_string(blobs));
  return hash.finish();
}

Sha256Digest digest_of_blob(const ShapeInfo& shape, const Blob& blob) {
  Sha256 hash;
  hash.add_text("timbre blob 1");
  hash.add_text(shape.name);
  hash.add_bytes(as_blob(shape.content));
  hash.add_text(blob.channel);
  hash.add_text(std::to_string(blob.version));
  hash.add_text(blob.parameters);
  hash.add_text(blob.bytes);
  return hash.finish();
}

bool same_bytes(const Sha256Digest& digest, std::span<const std::byte> bytes) {
  const auto own = as_blob(digest);
  return std::equal(own.begin(), own.end(), bytes.begin(), bytes.end());
}

}  // namespace detail
}  // namespace timbre
