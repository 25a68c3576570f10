#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre {

/// A function of space, negative inside a body, and its gradient there.
struct ImplicitValue {
  double value = 0.0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
};
using ImplicitFunction = std::function<ImplicitValue(const Eigen::Vector3d&)>;

/// A surface that the reflection x -> -x maps onto itself, exactly.
struct MirroredMesh {
  TriangleMesh mesh;
  std::vector<std::int32_t> mirror;  ///< n, an involution: the vertex at (-x, y, z)
};

/// Triangulates the level set `f = 0` with well-shaped triangles, outward oriented.
///
/// Half the body is cut by a body-centred cubic lattice that has x = 0 among its planes;
/// lattice points near the surface move onto it, so that no sliver is cut off. The
/// triangles are then evened out on the surface, and the half is mirrored.
///
/// @param f     even in x, smooth, close to the signed distance near its zeros
/// @param box   holds the surface
/// @param cell  lattice spacing; edges come out at about 3 / 4 of it. Where the body is
///              thinner than about 1.5 cells the surface may not be a manifold
/// @see Labelle and Shewchuk 2007, section 3 (lattice, warping, cutting)
[[nodiscard]] MirroredMesh make_isosurface(const ImplicitFunction& f,
                                           const Eigen::AlignedBox3d& box, double cell);

/// The same for any surface, all of it cut by one lattice, which is turned by `turn`.
/// Nothing about the triangles is symmetric.
/// @param f  need not be even
[[nodiscard]] TriangleMesh make_isosurface(const ImplicitFunction& f,
                                           const Eigen::AlignedBox3d& box, double cell,
                                           const Eigen::Quaterniond& turn);

}  // namespace timbre
