#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "timbre/analysis/core/sha256.h"
#include "timbre/analysis/mesh/triangle_mesh.h"
#include "timbre/index/store.h"

// Bytes of a database's rows, and the checksums that bind them to their places.
namespace timbre::detail {

/// Names of the blobs that are no channels.
inline constexpr char kMeshBlob[] = "mesh";
inline constexpr char kSpectrumBlob[] = "spectrum";

/// One row of table `blob`, apart from the shape it belongs to.
struct Blob {
  std::string channel;
  std::int64_t version = 1;
  std::string parameters;  ///< canonical text
  std::string bytes;
};

/// zstd over the coordinates (float64) and then the indices (int32), little-endian.
[[nodiscard]] std::string pack_mesh(const TriangleMesh& mesh);
/// @throws Error  bad_input if the bytes do not hold exactly this many, or no sound mesh: finite
///                coordinates, corners that are vertices
[[nodiscard]] TriangleMesh unpack_mesh(std::string_view bytes, std::int64_t vertices,
                                       std::int64_t faces);

/// float64, little-endian.
[[nodiscard]] std::string pack_numbers(const Eigen::VectorXd& values);
[[nodiscard]] Eigen::VectorXd unpack_numbers(std::string_view bytes);

[[nodiscard]] Sha256Digest digest_of_meta(std::string_view key, std::string_view value);
/// `blobs`: how many rows of table `blob` belong to the shape.
[[nodiscard]] Sha256Digest digest_of_shape(const ShapeInfo& shape, std::int64_t blobs);
/// Binds a blob to the shape's name and content and to its own channel, version and
/// parameters, so that rows cannot change places.
[[nodiscard]] Sha256Digest digest_of_blob(const ShapeInfo& shape, const Blob& blob);

[[nodiscard]] inline std::span<const std::byte> as_blob(std::string_view bytes) {
  return std::as_bytes(std::span(bytes));
}
[[nodiscard]] inline std::span<const std::byte> as_blob(const Sha256Digest& digest) {
  return std::as_bytes(std::span(digest));
}
[[nodiscard]] bool same_bytes(const Sha256Digest& digest, std::span<const std::byte> bytes);

}  // namespace timbre::detail
