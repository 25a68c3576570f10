#include "timbre/datasets/skeleton.h"

#include <gtest/gtest.h>

#include <numbers>

#include "timbre/datasets/species.h"

namespace timbre {
namespace {

using Eigen::Vector3d;

Skeleton skeleton_of(const std::string& species) { return make_skeleton(species); }

TEST(SkinOf, HasTheGradientOfItsValueAndIsEven) {
  const ImplicitFunction skin = skin_of(skeleton_of("dog"));
  Random random("points", {1});
  for (int i = 0; i < 200; ++i) {
    const Vector3d p(random.uniform(-0.3, 0.3), random.uniform(0.0, 1.0),
                     random.uniform(-0.6, 0.8));
    const ImplicitValue here = skin(p);
    const ImplicitValue image = skin(Vector3d(-p.x(), p.y(), p.z()));
    EXPECT_NEAR(here.value, image.value, 1e-12);
    const double h = 1e-6;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d step = h * Vector3d::Unit(axis);
      const double slope = (skin(p + step).value - skin(p - step).value) / (2.0 * h);
      EXPECT_NEAR(here.gradient[axis], slope, 1e-4);
    }
  }
}

TEST(TransformsOf, TurnAboutTheHeadAndCarryChildren) {
  const Skeleton skeleton = skeleton_of("person");
  Pose pose(skeleton.bones.size(), Vector3d::Zero());
  std::size_t forearm = 0;
  while (skeleton.bones[forearm].name != "forearm") ++forearm;
  pose[forearm] = Vector3d(0.3, -std::numbers::pi / 2.0, 0.1);
  const std::vector<Eigen::Affine3d> transforms =
      transforms_of(skeleton, pose, usual_build(skeleton));
  for (std::size_t b = 0; b < transforms.size(); ++b) {
    const Bone& bone = skeleton.bones[b];
    const bool is_hand = bone.parent == static_cast<int>(forearm);
    const double moved = (transforms[b] * bone.head - bone.head).norm();
    EXPECT_EQ(moved > 0.1, is_hand) << bone.name;
  }
  const Bone& bone = skeleton.bones[forearm];
  const Vector3d carried = transforms[forearm] * bone.tail - bone.head;
  EXPECT_NEAR(carried.norm(), (bone.tail - bone.head).norm(), 1e-12);
}

TEST(RandomPose, KeepsTheLimits) {
  const Skeleton skeleton = skeleton_of("gorilla");
  Random random("poses", {3});
  for (int i = 0; i < 10; ++i) {
    const Pose pose = random_pose(skeleton, random_build(skeleton, 0.2, random), random);
    for (std::size_t b = 0; b < pose.size(); ++b) {
      EXPECT_TRUE((pose[b].array() >= skeleton.bones[b].least.array()).all());
      EXPECT_TRUE((pose[b].array() <= skeleton.bones[b].most.array()).all());
    }
  }
}

TEST(MakeSkeleton, IsSymmetric) {
  for (const std::string& species : species_names()) {
    const Skeleton skeleton = make_skeleton(species);
    for (std::size_t b = 0; b < skeleton.bones.size(); ++b) {
      const Bone& bone = skeleton.bones[b];
      EXPECT_LT(bone.parent, static_cast<int>(b));
      if (!bone.name.ends_with(kRightSuffix)) continue;
      const Bone& left = skeleton.bones[b - 1];
      EXPECT_EQ(bone.name, left.name + std::string(kRightSuffix));
      EXPECT_EQ(bone.head, Vector3d(-left.head.x(), left.head.y(), left.head.z()));
      EXPECT_EQ(bone.tail, Vector3d(-left.tail.x(), left.tail.y(), left.tail.z()));
      EXPECT_EQ(bone.head_radius, left.head_radius);
    }
  }
}

TEST(RandomBuild, IsTheSameOnBothSidesAndInRange) {
  const Skeleton skeleton = skeleton_of("cat");
  Random random("builds", {5});
  const Build build = random_build(skeleton, 0.2, random);
  for (std::size_t b = 0; b < build.size(); ++b) {
    EXPECT_NEAR(build[b].length, 1.0, 0.2);
    EXPECT_NEAR(build[b].thickness, 1.0, 0.2);
    if (!skeleton.bones[b].name.ends_with(kRightSuffix)) continue;
    EXPECT_EQ(build[b].length, build[b - 1].length);
    EXPECT_EQ(build[b].thickness, build[b - 1].thickness);
  }
  EXPECT_NE(build[0].length, build[1].length);
}

TEST(TransformsOf, GrowBonesAlongAndAcrossAndMoveTheirChildren) {
  const Skeleton skeleton = skeleton_of("person");
  const Pose still(skeleton.bones.size(), Vector3d::Zero());
  Build build = usual_build(skeleton);
  std::size_t arm = 0;
  while (skeleton.bones[arm].name != "arm") ++arm;
  build[arm] = {.length = 1.5, .thickness = 0.8};
  const std::vector<Eigen::Affine3d> transforms = transforms_of(skeleton, still, build);
  const Bone& bone = skeleton.bones[arm];
  const Vector3d axis = bone.tail - bone.head;
  EXPECT_LT((transforms[arm] * bone.head - bone.head).norm(), 1e-12);
  EXPECT_LT((transforms[arm] * bone.tail - (bone.head + 1.5 * axis)).norm(), 1e-12);
  const Vector3d across = axis.cross(Vector3d::UnitY()).normalized();
  EXPECT_LT((transforms[arm].linear() * across - 0.8 * across).norm(), 1e-12);
  for (std::size_t b = 0; b < skeleton.bones.size(); ++b) {
    if (skeleton.bones[b].parent != static_cast<int>(arm)) continue;
    EXPECT_LT((transforms[b].linear() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_LT((transforms[b] * bone.tail - (bone.head + 1.5 * axis)).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace timbre
