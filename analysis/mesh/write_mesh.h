#pragma once

#include <cstdint>
#include <string>

#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre {

enum class MeshFormat : std::uint8_t { off, obj, ply };

/// The bytes of a file: OFF and OBJ as text with shortest round-trip numbers,
/// PLY binary little-endian with double coordinates. Reading them back gives
/// the same mesh, bit for bit.
[[nodiscard]] std::string to_mesh_bytes(const TriangleMesh& mesh, MeshFormat format);

/// Writes a mesh; the ending of `path` chooses the format. Whole or not at all.
/// @throws Error  bad_request for an unknown ending or, without `overwrite`, an
///                existing file; io when the system refuses
void write_mesh(const TriangleMesh& mesh, const std::string& path, bool overwrite = false);

}  // namespace timbre
