#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"
#include "timbre/cli/render/transfer.h"

namespace timbre::cli {

/// A surface of the 3D view.
struct ViewedSurface {
  const TriangleMesh& mesh;
  const VertexColours& colours;  ///< n x 3, sRGB; NaN: none
  std::string name;
};

/// Two surfaces that can be turned, and the map between them.
/// @param map       target vertex for each of the source, -1 for none
/// @param fallback  what stands there where 3D cannot be shown: HTML
[[nodiscard]] std::string viewer(const ViewedSurface& source, const ViewedSurface& target,
                                 const std::vector<std::int32_t>& map, UpAxis up,
                                 const std::string& fallback);

}  // namespace timbre::cli
