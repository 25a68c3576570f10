#pragma once

#include <cstdint>
#include <string>

#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre {

enum class MeshFormat : std::uint8_t { off, obj, ply, freesurfer, freesurfer_text, vtk, glb, stl };

/// The bytes of a file: OFF, OBJ and FreeSurfer's .asc as text with shortest round-trip
/// numbers, PLY and VTK (3.0, POLYDATA) binary with double coordinates. Reading them back gives
/// the same mesh, bit for bit. FreeSurfer's binary triangles, GLB (one mesh, one primitive) and
/// binary STL have float coordinates: they are rounded. STL has no list of vertices: reading it
/// back numbers them anew.
/// @throws Error  bad_request if a coordinate is beyond the range of the format's numbers, or
///                if a mesh without faces, or beyond 4 GiB, is to become a GLB or STL
[[nodiscard]] std::string to_mesh_bytes(const TriangleMesh& mesh, MeshFormat format);

/// The format that the ending of `path` asks for: .off, .obj, .ply, .vtk, .glb, .stl, .asc, or
/// one of the names of FreeSurfer's surfaces: .white .pial .inflated .sphere .orig .smoothwm .surf.
/// @throws Error  bad_request for another ending
[[nodiscard]] MeshFormat mesh_format_of(const std::string& path);

/// Writes a mesh in the format of `mesh_format_of`. Whole or not at all.
/// @throws Error  bad_request for an unknown ending or, without `overwrite`, an
///                existing file; io when the system refuses
void write_mesh(const TriangleMesh& mesh, const std::string& path, bool overwrite = false);

}  // namespace timbre
