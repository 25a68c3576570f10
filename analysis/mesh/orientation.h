#pragma once

#include <cstdint>

#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre {

enum class Orientation : std::uint8_t {
  outward,  ///< closed, consistent, turned so that the enclosed volume is positive
  unknown,  ///< open, non-manifold or one-sided: inside and outside cannot be told
};

struct OrientedFaces {
  Faces faces;  ///< the same triangles, some turned over; equal to the input if unknown
  Orientation orientation = Orientation::unknown;
};

/// Turns triangles over so that neighbours agree and normals point out of the volume.
/// Expects one connected component; triangles with a repeated corner are passed over.
[[nodiscard]] OrientedFaces orient_outward(const TriangleMesh& mesh);

}  // namespace timbre
