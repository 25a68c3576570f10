#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"
#include "timbre/cli/render/camera.h"

namespace timbre::cli {

/// A mesh made ready to be drawn.
struct RenderMesh {
  Points points;  ///< n x 3, y up; those in triangles lie in [-1, 1]^3
  Faces faces;    ///< the triangles that have an area, each once, turned outward
  /// Of each face, whether its two sides are told apart: not on one-sided surfaces, nor where
  /// the mesh has the triangle more than once.
  std::vector<bool> has_back;
  Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> face_normals;
  /// Of each corner of each face. Faces that meet at less than 50 degrees share normals;
  /// sharper edges stay sharp.
  std::vector<std::array<Eigen::Vector3f, 3>> corner_normals;
};

/// Rotates, moves and scales the mesh, turns its triangles and finds its normals.
/// @throws Error  bad_input if no triangle has an area
[[nodiscard]] RenderMesh make_render_mesh(const TriangleMesh& mesh, UpAxis up);

}  // namespace timbre::cli
