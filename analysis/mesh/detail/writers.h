#pragma once

#include <cstdint>
#include <string>

#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre::detail {

// Formats with float coordinates and files of their own. All throw Error, bad_request, if a
// coordinate is beyond the range of a float, or if there is nothing that the format can hold.

/// Binary glTF 2: one mesh of one primitive, with indices of 4 bytes.
[[nodiscard]] std::string glb_bytes(const TriangleMesh& mesh);

/// The bytes of vertices and faces in a GLB.
/// @throws Error  bad_request if there is no face, or more than a length of 32 bits can tell
[[nodiscard]] std::uint32_t glb_body_size(std::int64_t vertices, std::int64_t faces);

/// Binary STL. Only the corners of facets are kept, not which vertices they are.
[[nodiscard]] std::string stl_bytes(const TriangleMesh& mesh);

}  // namespace timbre::detail
