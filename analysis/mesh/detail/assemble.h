#pragma once

#include "timbre/analysis/mesh/detail/formats.h"
#include "timbre/analysis/mesh/read_mesh.h"

namespace timbre::detail {

/// Splits the polygons into triangles, leaves out those of less than three corners, and
/// finds what is odd about the rest. Vertices stay as they are.
/// @throws Error  bad_input if data follow though no face is declared, or for more than
///                2147483647 vertices or triangles
[[nodiscard]] MeshFile assemble(PolygonMesh polygons);

}  // namespace timbre::detail
