#include "timbre/datasets/skeleton.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace timbre {
namespace {

using Eigen::Vector3d;

// Where on the axis (0 head, 1 tail) a point is nearest.
double foot(const Bone& bone, const Vector3d& point) {
  const Vector3d axis = bone.tail - bone.head;
  return std::clamp((point - bone.head).dot(axis) / axis.squaredNorm(), 0.0, 1.0);
}

double radius_at(const Bone& bone, double t) {
  return bone.head_radius + t * (bone.tail_radius - bone.head_radius);
}

Vector3d axis_at(const Bone& bone, double t) { return bone.head + t * (bone.tail - bone.head); }

ImplicitValue capsule(const Bone& bone, const Vector3d& point) {
  const Vector3d axis = bone.tail - bone.head;
  const double t = foot(bone, point);
  const Vector3d away = point - axis_at(bone, t);
  const double distance = away.norm();
  ImplicitValue result;
  result.value = distance - radius_at(bone, t);
  if (distance > 0.0) result.gradient = away / distance;
  if (t > 0.0 && t < 1.0) {
    result.gradient -= (bone.tail_radius - bone.head_radius) / axis.squaredNorm() * axis;
  }
  return result;
}

// -blend log sum exp(-d / blend), taken relative to the smallest d so as not to overflow.
// Bones that would change it by less than a billionth of `blend` are passed over.
ImplicitValue smooth_union(const Skeleton& skeleton, const Vector3d& point) {
  const double reach = 20.0 * skeleton.blend;
  ImplicitValue result;
  result.value = std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (const Bone& bone : skeleton.bones) {
    const ImplicitValue next = capsule(bone, point);
    if (next.value > result.value + reach) continue;
    if (next.value < result.value) {
      const bool is_far = next.value < result.value - reach;
      const double fade = is_far ? 0.0 : std::exp((next.value - result.value) / skeleton.blend);
      sum *= fade;
      result.gradient *= fade;
      result.value = next.value;
    }
    const double weight = std::exp((result.value - next.value) / skeleton.blend);
    sum += weight;
    result.gradient += weight * next.gradient;
  }
  result.value -= skeleton.blend * std::log(sum);
  result.gradient /= sum;
  return result;
}

Eigen::Quaterniond rotation(const Vector3d& angles) {
  return Eigen::AngleAxisd(angles.z(), Vector3d::UnitZ()) *
         Eigen::AngleAxisd(angles.y(), Vector3d::UnitY()) *
         Eigen::AngleAxisd(angles.x(), Vector3d::UnitX());
}

// Scales along the bone by its length, across it by its thickness.
Eigen::Affine3d growth(const Bone& bone, const Proportion& proportion) {
  const Vector3d axis = (bone.tail - bone.head).normalized();
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  result.linear() *= proportion.thickness;
  result.linear() += (proportion.length - proportion.thickness) * axis * axis.transpose();
  return result;
}

struct Ball {
  Vector3d centre;
  double radius = 0.0;
};

std::vector<Ball> balls_along(const Bone& bone, const Eigen::Affine3d& transform,
                              double thickness) {
  constexpr int kBalls = 6;
  std::vector<Ball> balls;
  for (int i = 0; i < kBalls; ++i) {
    const double t = static_cast<double>(i) / (kBalls - 1);
    balls.push_back({transform * axis_at(bone, t), thickness * radius_at(bone, t)});
  }
  return balls;
}

double overlap(const std::vector<Ball>& one, const std::vector<Ball>& other) {
  double deepest = -std::numeric_limits<double>::infinity();
  for (const Ball& a : one) {
    for (const Ball& b : other) {
      deepest = std::max(deepest, a.radius + b.radius - (a.centre - b.centre).norm());
    }
  }
  return deepest;
}

// How deep each pair of bones (b > a) lies in each other; negative is clearance.
std::vector<double> overlaps(const Skeleton& skeleton,
                             const std::vector<Eigen::Affine3d>& transforms, const Build& build) {
  std::vector<std::vector<Ball>> balls;
  for (std::size_t b = 0; b < skeleton.bones.size(); ++b) {
    balls.push_back(balls_along(skeleton.bones[b], transforms[b], build[b].thickness));
  }
  std::vector<double> depths;
  for (std::size_t b = 1; b < balls.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) depths.push_back(overlap(balls[a], balls[b]));
  }
  return depths;
}

// Skins that are a blend apart do not touch. Pairs that are joined at rest do not count.
double collision(const std::vector<double>& rest, const std::vector<double>& posed, double blend) {
  double deepest = 0.0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    if (rest[i] < -blend) deepest = std::max(deepest, posed[i] + blend);
  }
  return deepest;
}

}  // namespace

BoneDistance distance_to(const Bone& bone, const Vector3d& point) {
  const double t = foot(bone, point);
  const double axis = (point - axis_at(bone, t)).norm();
  return {axis, axis - radius_at(bone, t)};
}

ImplicitFunction skin_of(const Skeleton& skeleton) {
  return [skeleton](const Vector3d& point) { return smooth_union(skeleton, point); };
}

Eigen::AlignedBox3d bounds_of(const Skeleton& skeleton) {
  Eigen::AlignedBox3d box;
  for (const Bone& bone : skeleton.bones) {
    const double reach = std::max(bone.head_radius, bone.tail_radius) + 3.0 * skeleton.blend;
    for (const Vector3d& end : {bone.head, bone.tail}) {
      box.extend(end + Vector3d::Constant(reach));
      box.extend(end - Vector3d::Constant(reach));
    }
  }
  return box;
}

Build usual_build(const Skeleton& skeleton) { return Build(skeleton.bones.size()); }

Build random_build(const Skeleton& skeleton, double variation, Random& random) {
  Build build;
  for (const Bone& bone : skeleton.bones) {
    const bool is_image = bone.name.ends_with(kRightSuffix);
    const Proportion drawn = {1.0 + random.uniform(-variation, variation),
                              1.0 + random.uniform(-variation, variation)};
    build.push_back(is_image ? build.back() : drawn);
  }
  return build;
}

std::vector<Eigen::Affine3d> transforms_of(const Skeleton& skeleton, const Pose& pose,
                                           const Build& build) {
  std::vector<Eigen::Affine3d> transforms;
  std::vector<Eigen::Quaterniond> turned;
  for (std::size_t b = 0; b < skeleton.bones.size(); ++b) {
    const Bone& bone = skeleton.bones[b];
    const auto parent = static_cast<std::size_t>(std::max(bone.parent, 0));
    const bool is_root = bone.parent < 0;
    turned.push_back(is_root ? rotation(pose[b]) : turned[parent] * rotation(pose[b]));
    const Vector3d head = is_root ? bone.head : transforms[parent] * bone.head;
    transforms.push_back(Eigen::Translation3d(head) * turned[b] * growth(bone, build[b]) *
                         Eigen::Translation3d(-bone.head));
  }
  return transforms;
}

Pose random_pose(const Skeleton& skeleton, const Build& build, Random& random) {
  constexpr int kAttempts = 100;
  const Pose still(skeleton.bones.size(), Vector3d::Zero());
  const std::vector<double> rest = overlaps(skeleton, transforms_of(skeleton, still, build), build);
  Pose best = still;
  double least = std::numeric_limits<double>::infinity();
  for (int attempt = 0; attempt < kAttempts && least > 0.0; ++attempt) {
    Pose pose;
    for (const Bone& bone : skeleton.bones) {
      Vector3d angles = Vector3d::Zero();
      for (int axis = 0; axis < 3; ++axis) {
        angles[axis] = random.uniform(bone.least[axis], bone.most[axis]);
      }
      pose.push_back(angles);
    }
    const double depth = collision(
        rest, overlaps(skeleton, transforms_of(skeleton, pose, build), build), skeleton.blend);
    if (depth >= least) continue;
    least = depth;
    best = std::move(pose);
  }
  return best;
}

}  // namespace timbre
