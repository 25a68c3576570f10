#pragma once

#include <Eigen/Core>

#include "timbre/cli/render/camera.h"
#include "timbre/cli/render/ray_scene.h"
#include "timbre/cli/render/render.h"
#include "timbre/cli/render/render_mesh.h"

namespace timbre::cli {

/// A ray of the camera; `direction` is 1 long along the camera's axis.
struct ViewRay {
  Eigen::Vector3f origin, direction;
  /// How the direction changes from one pixel to the next, to the right and downward.
  Eigen::Vector3f step_right, step_down;
};

/// What the eye meets at the end of a ray; colours are linear.
struct SurfacePoint {
  Eigen::Vector3f position;
  Eigen::Vector3f face_normal;  ///< towards the eye
  Eigen::Vector3f normal;       ///< the same, smooth
  Colour albedo;
};

/// Finds the colours of hits on one surface. Keeps references.
class SurfaceShader {
 public:
  SurfaceShader(const SurfaceLook& look, const RenderMesh& mesh, const std::vector<Ball>& balls);

  [[nodiscard]] SurfacePoint point_at(const RayHit& hit, const ViewRay& ray) const;

 private:
  struct Corners;
  [[nodiscard]] Colour colour_at(const Corners& corners) const;
  [[nodiscard]] float line_cover_at(const Corners& corners, const ViewRay& ray, float depth) const;
  [[nodiscard]] SurfacePoint face_point(const RayHit& hit, const ViewRay& ray) const;

  const SurfaceLook& look_;
  const RenderMesh& mesh_;
  const std::vector<Ball>& balls_;
  VertexColours colours_;  ///< linear
  ColourTable table_;      ///< linear
};

/// Light that reaches the eye, without and with what folds take away.
struct Light {
  Colour direct;   ///< from the lamps
  Colour ambient;  ///< from all around
};

/// A studio: a warm key light, a cool fill light, and a sky brighter than the ground.
class Studio {
 public:
  explicit Studio(const Camera& camera);

  [[nodiscard]] Light light_at(const SurfacePoint& point, const Eigen::Vector3f& to_eye) const;

 private:
  Eigen::Vector3f key_, fill_;
};

}  // namespace timbre::cli
