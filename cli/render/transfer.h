#pragma once

#include <cstdint>
#include <vector>

#include "timbre/cli/render/camera.h"
#include "timbre/cli/render/render.h"

namespace timbre::cli {

/// A colour for each vertex by where it lies: smooth, unlike for left and right, front and
/// back, and lighter towards the top.
[[nodiscard]] VertexColours position_colours(const TriangleMesh& mesh, UpAxis up);

/// Colours of a source surface on the target, through a map: a vertex gets the mean of the
/// colours that are mapped to it. One that gets none takes the mean of its neighbours, for a
/// few rings around coloured vertices; further away it has no colour (NaN).
///
/// @param map     target vertex for each row of `source`, -1 for none
/// @throws Error  bad_request if sizes do not agree or the map leads out of the target
[[nodiscard]] VertexColours carry_colours(const VertexColours& source,
                                          const std::vector<std::int32_t>& map,
                                          const TriangleMesh& target);

/// The colours without those of vertices that the map leaves out.
[[nodiscard]] VertexColours matched_colours(const VertexColours& source,
                                            const std::vector<std::int32_t>& map);

}  // namespace timbre::cli
