#include "timbre/cli/render/shading.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace timbre::cli {
namespace {

using Eigen::Vector3f;

// sRGB.
const Colour kClay(0.89F, 0.855F, 0.81F);
const Colour kNoColour(0.66F, 0.66F, 0.67F);
const Colour kInside(0.52F, 0.58F, 0.68F);
const Colour kLine(0.09F, 0.09F, 0.11F);

// Half the width of a line and of its soft edge, in pixels.
constexpr float kHalfLine = 0.75F;

ColourTable linear_table(ColourTable table) {
  for (Colour& colour : table) colour = to_linear(colour);
  return table;
}

Colour look_up(const ColourTable& table, double place) {
  const double at = place * static_cast<double>(table.size() - 1);
  const auto i = static_cast<std::size_t>(at);
  const std::size_t next = std::min(i + 1, table.size() - 1);
  const auto share = static_cast<float>(at - static_cast<double>(i));
  return (1.0F - share) * table[i] + share * table[next];
}

double nearest_level(const std::vector<double>& levels, double value) {
  double best = std::numeric_limits<double>::infinity();
  for (const double level : levels) {
    if (std::abs(value - level) < std::abs(value - best)) best = level;
  }
  return best;
}

}  // namespace

struct SurfaceShader::Corners {
  std::array<std::int32_t, 3> vertices{};
  std::array<float, 3> weights{};
  std::array<Vector3f, 3> points;
  Vector3f face_normal;

  [[nodiscard]] double mix(const Eigen::VectorXd& values) const {
    double sum = 0.0;
    for (std::size_t c = 0; c < 3; ++c) sum += double{weights[c]} * values(vertices[c]);
    return sum;
  }
  [[nodiscard]] std::int32_t nearest() const {
    const auto most = std::max_element(weights.begin(), weights.end()) - weights.begin();
    return vertices[static_cast<std::size_t>(most)];
  }
};

SurfaceShader::SurfaceShader(const SurfaceLook& look, const RenderMesh& mesh,
                             const std::vector<Ball>& balls)
    : look_(look), mesh_(mesh), balls_(balls), colours_(look.colours) {
  for (Eigen::Index i = 0; i < colours_.rows(); ++i) {
    colours_.row(i) = to_linear(Colour(colours_.row(i)));
  }
  if (look.field) table_ = linear_table(look.field->table);
}

Colour SurfaceShader::colour_at(const Corners& corners) const {
  Colour colour = to_linear(kClay);
  if (look_.field) {
    const ColourField& field = *look_.field;
    const double place =
        field.nearest ? field.places(corners.nearest()) : corners.mix(field.places);
    if (!std::isfinite(place)) return to_linear(kNoColour);
    colour = look_up(table_, std::clamp(place, 0.0, 1.0));
  } else if (colours_.rows() > 0) {
    colour.setZero();
    for (std::size_t c = 0; c < 3; ++c) {
      Colour at = colours_.row(corners.vertices[c]);
      if (!at.allFinite()) at = to_linear(kNoColour);
      colour += corners.weights[c] * at;
    }
  }
  return colour;
}

// The function is linear on the triangle, and so is, near by, the way from pixels to the
// triangle's plane: together they say how far away, in pixels, the level is.
float SurfaceShader::line_cover_at(const Corners& corners, const ViewRay& ray, float depth) const {
  const Eigen::VectorXd& values = look_.lines->values;
  const double value = corners.mix(values);
  const double off = std::abs(value - nearest_level(look_.lines->levels, value));
  const Vector3f& n = corners.face_normal;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  for (std::size_t c = 0; c < 3; ++c) {
    const Vector3f opposite = corners.points[(c + 2) % 3] - corners.points[(c + 1) % 3];
    gradient += values(corners.vertices[c]) * n.cross(opposite).cast<double>();
  }
  const Vector3f a = corners.points[1] - corners.points[0];
  const Vector3f b = corners.points[2] - corners.points[0];
  gradient /= double{a.cross(b).dot(n)};
  const auto change = [&](const Vector3f& step) {
    const Vector3f moved = depth * (step - ray.direction * (n.dot(step) / n.dot(ray.direction)));
    return gradient.dot(moved.cast<double>());
  };
  const double steepness = std::hypot(change(ray.step_right), change(ray.step_down));
  if (!(steepness > 0.0)) return 0.0F;
  const double pixels = off / steepness;
  return static_cast<float>(std::clamp(kHalfLine + 0.5 - pixels, 0.0, 1.0));
}

SurfacePoint SurfaceShader::face_point(const RayHit& hit, const ViewRay& ray) const {
  Corners corners;
  corners.weights = {1.0F - hit.u - hit.v, hit.u, hit.v};
  corners.face_normal = mesh_.face_normals.row(hit.face);
  SurfacePoint point;
  point.position.setZero();
  point.normal.setZero();
  for (std::size_t c = 0; c < 3; ++c) {
    corners.vertices[c] = mesh_.faces(hit.face, static_cast<Eigen::Index>(c));
    corners.points[c] = mesh_.points.row(corners.vertices[c]).cast<float>();
    point.position += corners.weights[c] * corners.points[c];
    point.normal +=
        corners.weights[c] * mesh_.corner_normals[static_cast<std::size_t>(hit.face)][c];
  }
  point.normal.normalize();
  point.albedo = colour_at(corners);
  point.face_normal = corners.face_normal;
  if (corners.face_normal.dot(ray.direction) > 0.0F) {
    point.face_normal = -point.face_normal;
    point.normal = -point.normal;
    if (mesh_.has_back[static_cast<std::size_t>(hit.face)]) {
      point.albedo = 0.45F * point.albedo + 0.55F * point.albedo.cwiseProduct(to_linear(kInside));
    }
  }
  if (look_.lines) {
    const float cover = line_cover_at(corners, ray, hit.depth);
    point.albedo = (1.0F - cover) * point.albedo + cover * to_linear(kLine);
  }
  return point;
}

SurfacePoint SurfaceShader::point_at(const RayHit& hit, const ViewRay& ray) const {
  if (hit.face >= 0) return face_point(hit, ray);
  const auto i = static_cast<std::size_t>(hit.ball);
  SurfacePoint point;
  point.position = ray.origin + hit.depth * ray.direction;
  point.normal = (point.position - balls_[i].centre).normalized();
  point.face_normal = point.normal;
  point.albedo = to_linear(look_.markers[i].colour);
  return point;
}

Studio::Studio(const Camera& camera) {
  const auto towards = [&](double right, double up, double back) {
    return Vector3f(
        (right * camera.right + up * camera.up - back * camera.forward).normalized().cast<float>());
  };
  key_ = towards(-0.55, 0.75, 0.75);
  fill_ = towards(0.85, 0.05, 0.5);
}

Light Studio::light_at(const SurfacePoint& point, const Vector3f& to_eye) const {
  static const Colour kKey(0.74F, 0.72F, 0.68F);
  static const Colour kFill(0.11F, 0.12F, 0.14F);
  static const Colour kSky(0.38F, 0.39F, 0.41F);
  static const Colour kGround(0.15F, 0.145F, 0.14F);
  const Vector3f& n = point.normal;
  // Large lamps: their light ends softly, a little behind the edge of the lit half.
  constexpr float kWrap = 0.25F;
  const auto lamp = [&](const Vector3f& towards) {
    const float facing = std::max(0.0F, (n.dot(towards) + kWrap) / (1.0F + kWrap));
    return facing * std::sqrt(facing);
  };
  const float upward = 0.5F + 0.5F * n.y();
  const Vector3f half = (key_ + to_eye).normalized();
  const float gloss = 0.045F * std::pow(std::max(0.0F, n.dot(half)), 24.0F);
  Light light;
  light.direct =
      point.albedo.cwiseProduct(lamp(key_) * kKey + lamp(fill_) * kFill) + gloss * Colour::Ones();
  light.ambient = point.albedo.cwiseProduct(upward * kSky + (1.0F - upward) * kGround);
  return light;
}

}  // namespace timbre::cli
