#pragma once

#include <string>

#include "timbre/analysis/mesh/read_mesh.h"

namespace timbre::detail {

/// TOSCA's text form: points in NAME.vert and triangles, counted from 1, in NAME.tri.
/// @throws Error  bad_input with file, line and cause; io
[[nodiscard]] MeshFile read_vert_tri(const std::string& file, const ReadOptions& options);

}  // namespace timbre::detail
