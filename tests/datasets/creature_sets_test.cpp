#include "timbre/datasets/creature_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/mesh/diagnosis.h"
#include "timbre/datasets/disturb.h"

namespace timbre {
namespace {

using Eigen::Index;

const CreatureBody& dog() {
  static const CreatureBody body = make_creature_body("dog", {.vertices = 4000});
  return body;
}

Creature make_of_set(CreatureSet set, int pose) {
  return make_creature(dog(), set, pose, {.vertices = 4000, .variation = 0.2, .shuffle = true});
}

// Made once for all tests.
const Creature& of_set(CreatureSet set, int pose = 1) {
  static std::map<std::pair<CreatureSet, int>, Creature> creatures;
  const auto known = creatures.find({set, pose});
  if (known != creatures.end()) return known->second;
  return creatures.emplace(std::pair(set, pose), make_of_set(set, pose)).first->second;
}

double mean_edge(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (Index f = 0; f < mesh.faces.rows(); ++f) {
    sum += (mesh.vertices.row(mesh.faces(f, 0)) - mesh.vertices.row(mesh.faces(f, 1))).norm();
  }
  return sum / static_cast<double>(mesh.faces.rows());
}

// Distance on the body at rest from each point of the template to its vertex.
std::vector<double> truth_errors(const Creature& creature) {
  std::vector<double> errors;
  for (std::size_t t = 0; t < creature.vertex_of_template.size(); ++t) {
    const std::int32_t v = creature.vertex_of_template[t];
    if (v < 0) continue;
    errors.push_back(
        (creature.rest.row(v) - dog().skin.rest.vertices.row(static_cast<Index>(t))).norm());
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

class EverySet : public testing::TestWithParam<CreatureSet> {};

TEST_P(EverySet, HasTruthAsGoodAsItsVertices) {
  const Creature& creature = of_set(GetParam());
  ASSERT_EQ(creature.rest.rows(), creature.mesh.vertices.rows());
  ASSERT_EQ(creature.part.size(), static_cast<std::size_t>(creature.mesh.vertices.rows()));
  TriangleMesh rest = creature.mesh;
  rest.vertices = creature.rest;
  const std::vector<double> errors = truth_errors(creature);
  ASSERT_GT(errors.size(), dog().skin.mirror.size() / 2);
  EXPECT_LT(errors[errors.size() * 95 / 100], 1.1 * mean_edge(rest));
  EXPECT_EQ(errors.back() == 0.0, GetParam() == CreatureSet::shared);
}

TEST_P(EverySet, HasAMirrorThatLeadsAcross) {
  const Creature& creature = of_set(GetParam());
  std::size_t good = 0;
  std::size_t known = 0;
  for (std::size_t v = 0; v < creature.mirror.size(); ++v) {
    if (creature.mirror[v] < 0) continue;
    ++known;
    Eigen::RowVector3d image = creature.rest.row(static_cast<Index>(v));
    image.x() *= -1.0;
    good += (creature.rest.row(creature.mirror[v]) - image).norm() < 0.05 ? 1 : 0;
  }
  EXPECT_GT(known, creature.mirror.size() / 4);
  EXPECT_GT(static_cast<double>(good), 0.9 * static_cast<double>(known));
}

TEST_P(EverySet, IsTheSameEachTime) {
  const Creature again = make_of_set(GetParam(), 1);
  EXPECT_EQ(of_set(GetParam()).mesh.vertices, again.mesh.vertices);
  EXPECT_EQ(of_set(GetParam()).mesh.faces, again.mesh.faces);
}
INSTANTIATE_TEST_SUITE_P(Sets, EverySet, testing::ValuesIn(all_creature_sets()),
                         [](const auto& set) { return std::string(to_word(set.param)); });

TEST(CreatureSets, DisturbOneThingEach) {
  const Creature& remeshed_creature = of_set(CreatureSet::remeshed);
  const Creature& welded_creature = of_set(CreatureSet::welded);
  const Diagnosis remeshed = diagnose(remeshed_creature.mesh);
  EXPECT_EQ(remeshed.boundary_loops, 0);
  EXPECT_EQ(remeshed.genus, 0);
  const Diagnosis holes = diagnose(of_set(CreatureSet::holes).mesh);
  EXPECT_GE(holes.boundary_loops, 1);
  EXPECT_LE(holes.boundary_loops, 8);
  const Diagnosis cut = diagnose(of_set(CreatureSet::cut).mesh);
  EXPECT_GE(cut.boundary_loops, 1);
  EXPECT_LT(cut.area, 0.85 * remeshed.area);
  const Diagnosis welded = diagnose(welded_creature.mesh);
  EXPECT_EQ(welded.boundary_loops, 0);
  EXPECT_EQ(welded.genus, 1);
  EXPECT_TRUE(welded.manifold);
  EXPECT_EQ(welded_creature.mesh.vertices, remeshed_creature.mesh.vertices);
  const auto count = [](const Creature& creature) {
    return static_cast<double>(creature.mesh.vertices.rows());
  };
  EXPECT_NEAR(count(of_set(CreatureSet::coarse)), count(remeshed_creature) / 4.0, 20.0);
  EXPECT_NEAR(count(of_set(CreatureSet::fine)), 12000.0, 900.0);
}

TEST(CreatureSets, TessellationsOfPosesDiffer) {
  EXPECT_NE(of_set(CreatureSet::remeshed, 1).mesh.faces.rows(),
            of_set(CreatureSet::remeshed, 2).mesh.faces.rows());
  EXPECT_EQ(of_set(CreatureSet::shared, 1).mesh.faces.rows(),
            of_set(CreatureSet::shared, 2).mesh.faces.rows());
}

TEST(CreatureSets, PartsCorrespondToTheWhole) {
  const Creature& part = of_set(CreatureSet::cut);
  const Creature& whole = of_set(CreatureSet::cut, 0);
  const std::vector<std::int32_t> map = correspondence(part, whole);
  ASSERT_EQ(map.size(), static_cast<std::size_t>(part.mesh.vertices.rows()));
  for (std::size_t v = 0; v < map.size(); ++v) {
    ASSERT_LT((whole.rest.row(map[v]) - part.rest.row(static_cast<Index>(v))).norm(), 0.04);
  }
}

TEST(AddNoise, MovesByTheStrengthAsked) {
  const TriangleMesh& before = of_set(CreatureSet::remeshed).mesh;
  Random random("noise", {1});
  const TriangleMesh after = add_noise(before, 0.5, random);
  const double moved = std::sqrt((after.vertices - before.vertices).rowwise().squaredNorm().mean());
  EXPECT_NEAR(moved / mean_edge(before), 0.5, 0.03);
  EXPECT_EQ(add_noise(before, 0.0, random).vertices, before.vertices);
}

TEST(Disturb, RefusesSharesThatLeaveNothing) {
  Random random("refused", {1});
  const TriangleMesh& mesh = dog().skin.rest;
  EXPECT_THROW((void)punch_holes(mesh, 10, 0.1, random), Error);
  EXPECT_THROW((void)cut_by_plane(mesh, 0.95, random), Error);
  EXPECT_THROW((void)add_noise(mesh, -1.0, random), Error);
}

}  // namespace
}  // namespace timbre
