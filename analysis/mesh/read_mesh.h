#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre {

/// Something about a file that was read all the same, and that a user may want to know.
struct ReadWarning {
  std::string code;        ///< stable word, for example `unused-vertex`
  std::int64_t count = 0;  ///< how often
  std::string message;     ///< a phrase for a person, with the first places
};

struct ReadOptions {
  std::uint64_t size_limit = std::uint64_t{4} << 30;  ///< bytes; larger files are refused
  bool soup = false;  ///< STL only: keep the corners of facets apart (3 m vertices)
};

struct MeshFile {
  TriangleMesh mesh;
  std::vector<ReadWarning> warnings;  ///< sorted by code
  std::string format;  ///< what the content was: off, obj, ply, stl, freesurfer, vtk or glb
};

/// Reads OFF, OBJ, PLY, STL, FreeSurfer surfaces (triangles, quads, .asc), legacy VTK or GLB
/// (binary glTF 2, uncompressed, placed as its scene says), told apart by content first and by
/// ending second, `.gz` unpacked. Vertex i of the file is row i of `vertices`: none is merged,
/// dropped or moved (STL, which has no vertex list, gets one vertex for each distinct corner
/// position, numbered by first appearance). Polygons become triangles in place. `-` reads standard
/// input.
///
/// Thread-safe; shares no state, uses no locale.
/// @throws Error  bad_input with file, place and cause; io when the system refuses
[[nodiscard]] MeshFile read_mesh(const std::string& path, const ReadOptions& options = {});

/// The same for bytes in memory. `name` stands in errors, and its ending helps
/// where the content leaves the format open.
[[nodiscard]] MeshFile read_mesh_bytes(std::string_view bytes, const std::string& name,
                                       const ReadOptions& options = {});

}  // namespace timbre
