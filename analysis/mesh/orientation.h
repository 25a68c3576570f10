#pragma once

#include <cstdint>

#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre {

enum class Orientation : std::uint8_t {
  outward,     ///< neighbours agree, and the enclosed volume says which side is out
  consistent,  ///< neighbours agree, but the surface is too open to have an inside
  none,        ///< one-sided: neighbours cannot all agree
};

struct OrientedFaces {
  Faces faces;  ///< the same triangles, some turned over; equal to the input for `none`
  Orientation orientation = Orientation::none;
};

/// Turns triangles over so that those on a common edge agree, and out of the volume where
/// there is one; else to the side that most of them show. Small holes and a few edges of three or
/// more triangles do no harm: `outward` asks that all but 2 % of the edges have two triangles.
/// Triangles with a repeated corner are passed over.
[[nodiscard]] OrientedFaces orient_outward(const TriangleMesh& mesh);

}  // namespace timbre
