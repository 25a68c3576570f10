#include "timbre/datasets/articulated.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/mesh/orientation.h"
#include "timbre/analysis/operators/operator.h"
#include "timbre/datasets/isosurface.h"
#include "timbre/datasets/random.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

void require_options_make_sense(const ArticulatedOptions& options) {
  if (options.vertices < 1000 || options.vertices > 50000) {
    throw Error(ErrorKind::bad_request, "", "vertices",
                std::to_string(options.vertices) + " asked for; 1000 to 50000 are possible");
  }
  if (!(options.variation >= 0.0 && options.variation < 0.3)) {
    throw Error(ErrorKind::bad_request, "", "variation", "must be at least 0 and below 0.3");
  }
}

// The number of vertices goes with 1 / cell^2; a first mesh gives the factor.
MirroredMesh skin(const Skeleton& skeleton, int vertices) {
  const ImplicitFunction f = skin_of(skeleton);
  const Eigen::AlignedBox3d box = bounds_of(skeleton);
  double area = 0.0;
  for (const Bone& bone : skeleton.bones) {
    area += std::numbers::pi * (bone.head_radius + bone.tail_radius) *
            ((bone.tail - bone.head).norm() + bone.tail_radius);
  }
  double cell = std::sqrt(3.0 * area / vertices);
  const MirroredMesh trial = make_isosurface(f, box, cell);
  cell *= std::sqrt(static_cast<double>(trial.mesh.vertices.rows()) / vertices);
  return make_isosurface(f, box, cell);
}

void require_sphere(const TriangleMesh& mesh, const std::string& species, int vertices) {
  const Operator op = compute_operator(mesh);
  const Index edges = mesh.faces.rows() * 3 / 2;
  const bool closed = orient_outward(mesh).orientation == Orientation::outward;
  const bool one = op.component_area.size() == 1;
  if (closed && one && mesh.vertices.rows() - edges + mesh.faces.rows() == 2) return;
  throw Error(ErrorKind::bad_input, "", "vertices",
              std::to_string(vertices) + " are too few for the thin parts of '" + species + "'");
}

// Each bone holds the skin nearest to it at temperature 1, the other bones theirs at 0.
// Heat is lost at the rate 1 / distance^2: blends are as wide as the limb is thick.
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
    const double loss = op.lumped_mass[v] / (least.axis * least.axis);
    system.coeffRef(v, v) += loss;
    source(v, nearest) = loss;
  }
  const Eigen::SimplicialLDLT<SparseMatrix> solver(system);
  // Obtuse angles can push a weight a little below 0.
  Eigen::MatrixXd weights = solver.solve(source).cwiseMax(0.0);
  const Eigen::VectorXd sums = weights.rowwise().sum();
  return sums.cwiseInverse().asDiagonal() * weights;
}

Points posed(const ArticulatedBody& body, const std::vector<Eigen::Isometry3d>& transforms) {
  Points moved = Points::Zero(body.rest.vertices.rows(), 3);
  for (std::size_t b = 0; b < transforms.size(); ++b) {
    const Points carried = (body.rest.vertices * transforms[b].linear().transpose()).rowwise() +
                           transforms[b].translation().transpose();
    moved += body.weights.col(static_cast<Index>(b)).asDiagonal() * carried;
  }
  return moved;
}

void shuffle(ArticulatedShape& shape, Random& random) {
  const TriangleMesh before = shape.mesh;
  const std::vector<std::int32_t> mirror = shape.mirror;
  const auto n = static_cast<std::int32_t>(before.vertices.rows());
  shape.vertex_of_template = random.permutation(n);
  for (std::int32_t t = 0; t < n; ++t) {
    const std::int32_t v = shape.vertex_of_template[static_cast<std::size_t>(t)];
    shape.mesh.vertices.row(v) = before.vertices.row(t);
    shape.mirror[static_cast<std::size_t>(v)] =
        shape.vertex_of_template[static_cast<std::size_t>(mirror[static_cast<std::size_t>(t)])];
  }
  const std::vector<std::int32_t> order =
      random.permutation(static_cast<std::int32_t>(before.faces.rows()));
  for (Index f = 0; f < before.faces.rows(); ++f) {
    for (Index c = 0; c < 3; ++c) {
      shape.mesh.faces(order[static_cast<std::size_t>(f)], c) =
          shape.vertex_of_template[static_cast<std::size_t>(before.faces(f, c))];
    }
  }
}

}  // namespace

ArticulatedBody make_articulated_body(const std::string& species,
                                      const ArticulatedOptions& options) {
  require_options_make_sense(options);
  Random random("proportions " + species, {options.seed});
  ArticulatedBody body;
  body.species = species;
  body.skeleton = make_skeleton(species, options.variation, random);
  MirroredMesh surface = skin(body.skeleton, options.vertices);
  require_sphere(surface.mesh, species, options.vertices);
  body.rest = std::move(surface.mesh);
  body.mirror = std::move(surface.mirror);
  body.weights = heat_weights(body.rest, body.skeleton);
  return body;
}

ArticulatedShape make_articulated(const ArticulatedBody& body, int pose,
                                  const ArticulatedOptions& options) {
  if (pose < 0) {
    throw Error(ErrorKind::bad_request, "", "pose",
                std::to_string(pose) + " asked for; poses count from 0");
  }
  Random random("pose " + body.species, {options.seed, static_cast<std::uint64_t>(pose)});
  ArticulatedShape shape;
  shape.species = body.species;
  shape.pose = pose;
  shape.mesh = body.rest;
  shape.mirror = body.mirror;
  shape.vertex_of_template.resize(body.mirror.size());
  std::iota(shape.vertex_of_template.begin(), shape.vertex_of_template.end(), 0);
  if (pose > 0) {
    const Pose turns = random_pose(body.skeleton, random);
    shape.mesh.vertices = posed(body, transforms_of(body.skeleton, turns));
  }
  if (options.shuffle) shuffle(shape, random);
  return shape;
}

ArticulatedShape make_articulated(const std::string& species, int pose,
                                  const ArticulatedOptions& options) {
  return make_articulated(make_articulated_body(species, options), pose, options);
}

}  // namespace timbre
