#include "timbre/datasets/creatures.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/operators/operator.h"
#include "timbre/datasets/detail/creature_checks.h"
#include "timbre/datasets/isosurface.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

void require_options_make_sense(const CreatureOptions& options) {
  detail::require_possible_count(options.vertices);
  if (!(options.variation >= 0.0 && options.variation < 0.4)) {
    throw Error(ErrorKind::bad_request, "", "variation", "must be at least 0 and below 0.4");
  }
}

// The number of vertices goes with 1 / cell^2; a first mesh gives the factor.
double cell_for(const Skeleton& skeleton, int vertices) {
  double area = 0.0;
  for (const Bone& bone : skeleton.bones) {
    area += std::numbers::pi * (bone.head_radius + bone.tail_radius) *
            ((bone.tail - bone.head).norm() + bone.tail_radius);
  }
  const double cell = std::sqrt(3.0 * area / vertices);
  const MirroredMesh trial = make_isosurface(skin_of(skeleton), bounds_of(skeleton), cell);
  return cell * std::sqrt(static_cast<double>(trial.mesh.vertices.rows()) / vertices);
}

// Each bone holds the skin nearest to it at temperature 1, the other bones theirs at 0.
// Heat is lost at the rate 1 / (2 distance^2): blends are about as wide as the limb is thick.
Eigen::MatrixXd heat_weights(const TriangleMesh& mesh, const Skeleton& skeleton) {
  const Operator op = compute_operator(mesh);
  const Index n = mesh.vertices.rows();
  SparseMatrix system = op.stiffness;
  Eigen::MatrixXd source = Eigen::MatrixXd::Zero(n, static_cast<Index>(skeleton.bones.size()));
  for (Index v = 0; v < n; ++v) {
    const Vector3d point = mesh.vertices.row(v).transpose();
    BoneDistance least = distance_to(skeleton.bones[0], point);
    Index nearest = 0;
    for (std::size_t b = 1; b < skeleton.bones.size(); ++b) {
      const BoneDistance next = distance_to(skeleton.bones[b], point);
      if (next.skin >= least.skin) continue;
      least = next;
      nearest = static_cast<Index>(b);
    }
    const double loss = 0.5 * op.lumped_mass[v] / (least.axis * least.axis);
    system.coeffRef(v, v) += loss;
    source(v, nearest) = loss;
  }
  const Eigen::SimplicialLDLT<SparseMatrix> solver(system);
  // Obtuse angles can push a weight a little below 0.
  Eigen::MatrixXd weights = solver.solve(source).cwiseMax(0.0);
  const Eigen::VectorXd sums = weights.rowwise().sum();
  return sums.cwiseInverse().asDiagonal() * weights;
}

Points posed(const CreatureSkin& skin, const std::vector<Eigen::Affine3d>& transforms) {
  Points moved = Points::Zero(skin.rest.vertices.rows(), 3);
  for (std::size_t b = 0; b < transforms.size(); ++b) {
    const Points carried = (skin.rest.vertices * transforms[b].linear().transpose()).rowwise() +
                           transforms[b].translation().transpose();
    moved += skin.weights.col(static_cast<Index>(b)).asDiagonal() * carried;
  }
  return moved;
}

std::vector<std::int32_t> parts_of(const CreatureSkin& skin) {
  std::vector<std::int32_t> parts;
  parts.reserve(static_cast<std::size_t>(skin.weights.rows()));
  for (Index v = 0; v < skin.weights.rows(); ++v) {
    Index bone = 0;
    skin.weights.row(v).maxCoeff(&bone);
    parts.push_back(static_cast<std::int32_t>(bone));
  }
  return parts;
}

void shuffle(Creature& creature, Random& random) {
  const Creature before = creature;
  const std::vector<std::int32_t> to =
      random.permutation(static_cast<std::int32_t>(before.mesh.vertices.rows()));
  for (std::size_t v = 0; v < to.size(); ++v) {
    creature.mesh.vertices.row(to[v]) = before.mesh.vertices.row(static_cast<Index>(v));
    const auto moved = static_cast<std::size_t>(to[v]);
    creature.mirror[moved] = to[static_cast<std::size_t>(before.mirror[v])];
    creature.part[moved] = before.part[v];
    creature.rest.row(to[v]) = before.rest.row(static_cast<Index>(v));
  }
  for (std::int32_t& v : creature.vertex_of_template) v = to[static_cast<std::size_t>(v)];
  const std::vector<std::int32_t> order =
      random.permutation(static_cast<std::int32_t>(before.mesh.faces.rows()));
  for (Index f = 0; f < before.mesh.faces.rows(); ++f) {
    for (Index c = 0; c < 3; ++c) {
      creature.mesh.faces(order[static_cast<std::size_t>(f)], c) =
          to[static_cast<std::size_t>(before.mesh.faces(f, c))];
    }
  }
}

}  // namespace

CreatureBody make_creature_body(const std::string& species, const CreatureOptions& options) {
  require_options_make_sense(options);
  CreatureBody body;
  body.species = species;
  body.skeleton = make_skeleton(species);
  body.cell = cell_for(body.skeleton, options.vertices);
  MirroredMesh surface =
      make_isosurface(skin_of(body.skeleton), bounds_of(body.skeleton), body.cell);
  if (!detail::is_sphere(surface.mesh)) detail::refuse_count(options.vertices, species);
  body.skin.rest = std::move(surface.mesh);
  body.skin.mirror = std::move(surface.mirror);
  body.skin.weights = heat_weights(body.skin.rest, body.skeleton);
  body.skin.vertex_of_template.resize(body.skin.mirror.size());
  std::iota(body.skin.vertex_of_template.begin(), body.skin.vertex_of_template.end(), 0);
  return body;
}

Creature make_creature(const CreatureBody& body, const CreatureSkin& skin, int pose,
                       const CreatureOptions& options) {
  require_options_make_sense(options);
  if (pose < 0) {
    throw Error(ErrorKind::bad_request, "", "pose",
                std::to_string(pose) + " asked for; poses count from 0");
  }
  Random random("pose " + body.species, {options.seed, static_cast<std::uint64_t>(pose)});
  Creature creature;
  creature.species = body.species;
  creature.pose = pose;
  creature.mesh = skin.rest;
  creature.rest = skin.rest.vertices;
  creature.vertex_of_template = skin.vertex_of_template;
  creature.mirror = skin.mirror;
  creature.part = parts_of(skin);
  if (pose > 0) {
    const Build build = random_build(body.skeleton, options.variation, random);
    const Pose turns = random_pose(body.skeleton, build, random);
    creature.mesh.vertices = posed(skin, transforms_of(body.skeleton, turns, build));
  }
  if (options.shuffle) shuffle(creature, random);
  return creature;
}

Creature make_creature(const CreatureBody& body, int pose, const CreatureOptions& options) {
  return make_creature(body, body.skin, pose, options);
}

}  // namespace timbre
