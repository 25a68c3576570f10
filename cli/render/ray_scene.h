#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre::cli {

struct Ball {
  Eigen::Vector3f centre;
  float radius = 0.0F;
};

struct RayHit {
  std::int32_t face = -1;  ///< -1 for a ball
  std::int32_t ball = -1;  ///< -1 for a face
  float depth = 0.0F;      ///< in lengths of the direction
  float u = 0.0F;          ///< weight of the face's second corner
  float v = 0.0F;          ///< weight of the face's third corner

  [[nodiscard]] bool any() const { return face >= 0 || ball >= 0; }
};

/// Triangles and balls that rays are cast at, in single precision. Rays may be cast from
/// many threads at once.
class RayScene {
 public:
  /// @throws std::bad_alloc
  RayScene(const Points& points, const Faces& faces, const std::vector<Ball>& balls);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  /// The first thing along a ray, or nothing.
  [[nodiscard]] RayHit first_hit(const Eigen::Vector3f& origin,
                                 const Eigen::Vector3f& direction) const;

  /// Whether anything lies on a ray between its origin and `far` lengths of the direction.
  [[nodiscard]] bool is_blocked(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                                float far) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace timbre::cli
