#include "timbre/cli/render/render.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>
#include <string>
#include <thread>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/threads.h"
#include "timbre/cli/render/ray_scene.h"
#include "timbre/cli/render/render_mesh.h"
#include "timbre/cli/render/shading.h"

namespace timbre::cli {
namespace {

using Eigen::Vector3f;

// Rays of the eye for each pixel, on a lattice where each has a row and a column of its
// own: an edge of any direction gets steps of a ninth.
constexpr int kEyeRays = 9;
// Rays into the surroundings, for each ray of the eye.
constexpr int kSkyRays = 6;
// What is farther away than this does not darken. The mesh is 2 long.
constexpr float kReach = 0.9F;
// Rays start this far off the surface. Less than a pixel; more than rounding.
constexpr float kLift = 1e-3F;

struct Pixel {
  Colour direct = Colour::Zero();
  Colour ambient = Colour::Zero();
  Vector3f normal = Vector3f::Zero();
  float depth = 0.0F;
  float openness = 1.0F;  ///< the share of the surroundings that is seen
  int hits = 0;           ///< of the eye's rays; the colours are their sums
};

struct Scene {
  const SurfaceShader& shader;
  const RayScene& rays;
  Camera camera;
  Studio studio;
  int width, height;
};

// A hash of the pixel: neighbours look into unlike directions, and what is left of the
// pattern after 54 rays is smoothed away later.
std::uint32_t scramble(std::uint32_t x, std::uint32_t y) {
  std::uint32_t h = x * 0x9e3779b1U ^ (y + 0x7f4a7c15U) * 0x85ebca77U;
  h = (h ^ (h >> 15)) * 0x2c1b3c6dU;
  h = (h ^ (h >> 12)) * 0x297a2d39U;
  return h ^ (h >> 15);
}

float fraction(float x) { return x - std::floor(x); }

// The i-th point of an even sequence in the unit cube, moved by `seed`.
Vector3f even_point(std::uint32_t seed, int i) {
  // Powers of 1/g, where g^4 = g + 1.
  static const Vector3f kStep(0.8191725F, 0.6710436F, 0.5497005F);
  const Vector3f start(static_cast<float>(seed & 0x3ffU) / 1024.0F,
                       static_cast<float>((seed >> 10) & 0x3ffU) / 1024.0F,
                       static_cast<float>((seed >> 20) & 0x3ffU) / 1024.0F);
  return (start + static_cast<float>(i + 1) * kStep).unaryExpr(&fraction);
}

// Two directions at right angles to a unit vector.
std::array<Vector3f, 2> across(const Vector3f& n) {
  const Vector3f axis = std::abs(n.x()) < 0.6F ? Vector3f::UnitX() : Vector3f::UnitY();
  const Vector3f first = n.cross(axis).normalized();
  return {first, n.cross(first)};
}

// The share of `kSkyRays` that get away. A ray's own reach is random, so that on average
// near things darken more than far ones.
float openness_at(const Scene& scene, const SurfacePoint& point, std::uint32_t seed, int first) {
  const auto [s, t] = across(point.normal);
  const Vector3f from = point.position + kLift * point.face_normal;
  int free = 0;
  for (int i = 0; i < kSkyRays; ++i) {
    const Vector3f random = even_point(seed, first + i);
    const float radius = std::sqrt(random.x());
    const float angle = 2.0F * std::numbers::pi_v<float> * random.y();
    Vector3f direction = radius * (std::cos(angle) * s + std::sin(angle) * t) +
                         std::sqrt(1.0F - random.x()) * point.normal;
    // Where the smooth normal leans, some directions lie below the triangle itself.
    const float above = direction.dot(point.face_normal);
    if (above < 0.0F) direction -= 2.0F * above * point.face_normal;
    const float reach = kReach * random.z();
    free += scene.rays.is_blocked(from, direction, reach) ? 0 : 1;
  }
  return static_cast<float>(free) / kSkyRays;
}

ViewRay view_ray(const Scene& scene, float x, float y) {
  const Camera& camera = scene.camera;
  const double step_x = 2.0 * camera.half_width / scene.width;
  const double step_y = 2.0 * camera.half_height / scene.height;
  ViewRay ray;
  ray.origin = camera.eye.cast<float>();
  ray.direction = (camera.forward + (double{x} * step_x - camera.half_width) * camera.right -
                   (double{y} * step_y - camera.half_height) * camera.up)
                      .cast<float>();
  ray.step_right = (step_x * camera.right).cast<float>();
  ray.step_down = (-step_y * camera.up).cast<float>();
  return ray;
}

Pixel trace_pixel(const Scene& scene, int x, int y) {
  Pixel pixel;
  float openness = 0.0F;
  const std::uint32_t seed = scramble(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
  for (int i = 0; i < kEyeRays; ++i) {
    const float dx = (static_cast<float>(i) + 0.5F) / kEyeRays;
    const float dy = (static_cast<float>(2 * i % kEyeRays) + 0.5F) / kEyeRays;
    const ViewRay ray = view_ray(scene, static_cast<float>(x) + dx, static_cast<float>(y) + dy);
    const RayHit hit = scene.rays.first_hit(ray.origin, ray.direction);
    if (!hit.any()) continue;
    const SurfacePoint point = scene.shader.point_at(hit, ray);
    const Light light = scene.studio.light_at(point, -ray.direction.normalized());
    pixel.direct += light.direct;
    pixel.ambient += light.ambient;
    pixel.normal += point.normal;
    pixel.depth += hit.depth;
    openness += openness_at(scene, point, seed, i * kSkyRays);
    ++pixel.hits;
  }
  if (pixel.hits > 0) {
    const auto hits = static_cast<float>(pixel.hits);
    pixel.depth /= hits;
    pixel.normal.normalize();
    pixel.openness = openness / hits;
  }
  return pixel;
}

// Counts rows done on any thread, and reports them from the caller's.
class RowProgress {
 public:
  RowProgress(const Progress& progress, std::int64_t rows) : reporter_(progress, "rows", rows) {}

  void advance() {
    const std::int64_t done = ++done_;
    if (std::this_thread::get_id() == caller_) reporter_.advance_to(done);
  }

 private:
  ProgressReporter reporter_;
  std::atomic<std::int64_t> done_{0};
  std::thread::id caller_ = std::this_thread::get_id();
};

using Film = std::vector<Pixel>;

std::size_t at(const Scene& scene, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(scene.width) +
         static_cast<std::size_t>(x);
}

// The mean over near pixels of the same sheet of surface: rays are few, and openness
// changes slowly there.
float smooth_openness(const Scene& scene, const Film& film, int x, int y) {
  constexpr int kAround = 2;
  const Pixel& centre = film[at(scene, x, y)];
  const float pixel_size = static_cast<float>(2.0 * scene.camera.half_width / scene.width);
  const float step = centre.depth * pixel_size * 4.0F * kAround;
  float sum = 0.0F;
  float weights = 0.0F;
  for (int v = std::max(0, y - kAround); v <= std::min(scene.height - 1, y + kAround); ++v) {
    for (int u = std::max(0, x - kAround); u <= std::min(scene.width - 1, x + kAround); ++u) {
      const Pixel& other = film[at(scene, u, v)];
      if (other.hits == 0) continue;
      const float turn = std::max(0.0F, other.normal.dot(centre.normal));
      const float jump = (other.depth - centre.depth) / step;
      const float weight =
          static_cast<float>(other.hits) * std::pow(turn, 8.0F) * std::exp(-jump * jump);
      sum += weight * other.openness;
      weights += weight;
    }
  }
  return weights > 0.0F ? sum / weights : centre.openness;
}

std::uint8_t to_byte(float share) {
  return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(share, 0.0F, 1.0F)));
}

void develop(const Pixel& pixel, float openness, const std::optional<Colour>& background,
             std::uint8_t* rgba) {
  // Lamps are large: folds lose some of their light too.
  constexpr float kLampShare = 0.5F;
  const float lamps = 1.0F - kLampShare * (1.0F - openness);
  const auto hits = static_cast<float>(std::max(1, pixel.hits));
  const float cover = static_cast<float>(pixel.hits) / kEyeRays;
  Colour linear = (lamps * pixel.direct + openness * pixel.ambient) / hits;
  if (background) linear = cover * linear + (1.0F - cover) * to_linear(*background);
  const Colour colour = to_srgb(linear.cwiseMax(0.0F).cwiseMin(1.0F));
  for (int c = 0; c < 3; ++c) rgba[c] = to_byte(colour(c));
  rgba[3] = background ? 255 : to_byte(cover);
}

Image draw(const Scene& scene, const RenderOptions& options, RowProgress& rows) {
  Film film(static_cast<std::size_t>(scene.width) * static_cast<std::size_t>(scene.height));
  parallel_for(scene.height, options.threads, [&](std::int64_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < scene.width; ++x) film[at(scene, x, y)] = trace_pixel(scene, x, y);
    rows.advance();
  });
  Image image{scene.width, scene.height, std::vector<std::uint8_t>(4 * film.size())};
  parallel_for(scene.height, options.threads, [&](std::int64_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < scene.width; ++x) {
      const std::size_t i = at(scene, x, y);
      const float openness = film[i].hits > 0 ? smooth_openness(scene, film, x, y) : 1.0F;
      develop(film[i], openness, options.background, &image.rgba[4 * i]);
    }
  });
  return image;
}

void require_size(Eigen::Index given, Eigen::Index vertices, const char* what) {
  if (given == vertices) return;
  throw Error(ErrorKind::bad_request, "", what,
              "are " + std::to_string(given) + ", but the mesh has " + std::to_string(vertices) +
                  " vertices");
}

void require_request_makes_sense(const SurfaceLook& look, const RenderOptions& options) {
  const Eigen::Index n = look.mesh.vertices.rows();
  if (options.width < 1 || options.height < 1) {
    throw Error(ErrorKind::bad_request, "", "size", "at least 1 x 1 pixel is needed");
  }
  if (look.colours.rows() > 0) require_size(look.colours.rows(), n, "colours");
  if (look.field) require_size(look.field->places.size(), n, "values");
  if (look.lines) require_size(look.lines->values.size(), n, "values");
  for (const Marker& marker : look.markers) {
    if (marker.vertex >= 0 && marker.vertex < n) continue;
    throw Error(ErrorKind::bad_request, "", "marker",
                std::to_string(marker.vertex) + " is no vertex; there are " + std::to_string(n) +
                    ", from 0");
  }
}

std::vector<Camera> fit_cameras(const RenderMesh& mesh, const std::vector<View>& views,
                                double aspect) {
  // Vertices in no triangle are not seen.
  std::vector<char> used(static_cast<std::size_t>(mesh.points.rows()));
  for (const std::int32_t v : mesh.faces.reshaped()) used[static_cast<std::size_t>(v)] = 1;
  Points seen(std::count(used.begin(), used.end(), 1), 3);
  for (Eigen::Index i = 0, row = 0; i < mesh.points.rows(); ++i) {
    if (used[static_cast<std::size_t>(i)] != 0) seen.row(row++) = mesh.points.row(i);
  }
  std::vector<Camera> cameras;
  double farthest = 0.0;
  for (const View& view : views) {
    cameras.push_back(fit_camera(seen, view, aspect));
    farthest = std::max(farthest, distance_of(cameras.back()));
  }
  for (Camera& camera : cameras) withdraw(camera, farthest);
  return cameras;
}

}  // namespace

std::vector<Image> render(const SurfaceLook& look, const std::vector<View>& views,
                          const RenderOptions& options) {
  require_request_makes_sense(look, options);
  const RenderMesh mesh = make_render_mesh(look.mesh, options.up);
  std::vector<Ball> balls;
  for (const Marker& marker : look.markers) {
    balls.push_back({mesh.points.row(marker.vertex).cast<float>(), marker.radius});
  }
  const RayScene rays(mesh.points, mesh.faces, balls);
  const SurfaceShader shader(look, mesh, balls);
  const double aspect = static_cast<double>(options.width) / options.height;
  RowProgress rows(options.progress,
                   std::int64_t{options.height} * static_cast<std::int64_t>(views.size()));
  std::vector<Image> images;
  for (const Camera& camera : fit_cameras(mesh, views, aspect)) {
    const Scene scene{shader, rays, camera, Studio(camera), options.width, options.height};
    images.push_back(draw(scene, options, rows));
  }
  return images;
}

}  // namespace timbre::cli
