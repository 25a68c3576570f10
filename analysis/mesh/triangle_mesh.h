#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace timbre {

using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Faces = Eigen::Matrix<std::int32_t, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// A list of points and a list of triangles, in the order of the file they came
/// from. Nothing else is promised: edges may be non-manifold, triangles may be
/// degenerate, vertices may be unused.
struct TriangleMesh {
  Points vertices;  ///< n x 3, in the file's unit of length, finite
  Faces faces;      ///< m x 3, indices into `vertices`
};

}  // namespace timbre
