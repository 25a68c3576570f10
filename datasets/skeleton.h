#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "timbre/datasets/isosurface.h"
#include "timbre/datasets/random.h"

namespace timbre {

/// What the name of a bone's mirror image has behind it.
inline constexpr std::string_view kRightSuffix = ".right";

/// A tapered capsule that turns about its head, carried by its parent.
struct Bone {
  std::string name;
  int parent = -1;  ///< an earlier bone; -1 for the root
  Eigen::Vector3d head, tail;
  double head_radius = 0.0, tail_radius = 0.0;
  Eigen::Vector3d least, most;  ///< turns about the axes x, y, z, in that order; radians
};

/// A body at rest: y is up, z forward, x to its left, and x -> -x maps it onto itself.
/// Units are metres, or what a metre would be to a creature of that kind.
struct Skeleton {
  std::vector<Bone> bones;  ///< parents before children
  double blend = 0.02;      ///< where bones meet, the skin is rounded over about 3 of these
};

/// One turn for each bone: angles about x, y, z, about its head.
using Pose = std::vector<Eigen::Vector3d>;

/// Distance from a point to a bone's axis, and to its capsule (negative inside).
struct BoneDistance {
  double axis = 0.0;
  double skin = 0.0;
};
[[nodiscard]] BoneDistance distance_to(const Bone& bone, const Eigen::Vector3d& point);

/// The skin at rest: a smooth union of the capsules, near to a signed distance.
[[nodiscard]] ImplicitFunction skin_of(const Skeleton& skeleton);

/// A box around all capsules at rest.
[[nodiscard]] Eigen::AlignedBox3d bounds_of(const Skeleton& skeleton);

/// How an individual differs from the skeleton: one factor for each bone's length and one
/// for its thickness.
struct Proportion {
  double length = 1.0;
  double thickness = 1.0;
};
using Build = std::vector<Proportion>;

/// The build of the skeleton itself: all factors 1.
[[nodiscard]] Build usual_build(const Skeleton& skeleton);

/// Factors drawn from [1 - variation, 1 + variation], left and right alike.
[[nodiscard]] Build random_build(const Skeleton& skeleton, double variation, Random& random);

/// Where a pose takes each bone of an individual: bones grow along and across their axes,
/// and carry the heads of their children along.
[[nodiscard]] std::vector<Eigen::Affine3d> transforms_of(const Skeleton& skeleton, const Pose& pose,
                                                         const Build& build);

/// A pose within the limits, in which limbs keep out of each other as well as they do at rest.
[[nodiscard]] Pose random_pose(const Skeleton& skeleton, const Build& build, Random& random);

}  // namespace timbre
