#include "timbre/datasets/creatures.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/mesh/orientation.h"
#include "timbre/analysis/mesh/write_mesh.h"
#include "timbre/analysis/operators/operator.h"
#include "timbre/analysis/spectrum/spectrum.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::Vector3d;
using Eigen::VectorXd;

Vector3d corner(const TriangleMesh& mesh, Index f, Index c) {
  return mesh.vertices.row(mesh.faces(f, c % 3)).transpose();
}

Vector3d normal(const TriangleMesh& mesh, Index f) {
  const Vector3d a = corner(mesh, f, 0);
  return (corner(mesh, f, 1) - a).cross(corner(mesh, f, 2) - a).normalized();
}

// Least angle of each triangle, degrees, ascending.
std::vector<double> least_angles(const TriangleMesh& mesh) {
  std::vector<double> angles;
  for (Index f = 0; f < mesh.faces.rows(); ++f) {
    double least = 180.0;
    for (Index c = 0; c < 3; ++c) {
      const Vector3d p = corner(mesh, f, c + 1) - corner(mesh, f, c);
      const Vector3d q = corner(mesh, f, c + 2) - corner(mesh, f, c);
      least = std::min(least, std::atan2(p.cross(q).norm(), p.dot(q)) * 180.0 / std::numbers::pi);
    }
    angles.push_back(least);
  }
  std::sort(angles.begin(), angles.end());
  return angles;
}

double mean_stretch(const TriangleMesh& rest, const TriangleMesh& posed) {
  double sum = 0.0;
  for (Index f = 0; f < rest.faces.rows(); ++f) {
    for (Index c = 0; c < 3; ++c) {
      sum += std::abs(std::log((corner(posed, f, c + 1) - corner(posed, f, c)).norm() /
                               (corner(rest, f, c + 1) - corner(rest, f, c)).norm()));
    }
  }
  return sum / static_cast<double>(3 * rest.faces.rows());
}

// The sharpest angle between the normals of neighbours, as its cosine.
double sharpest_fold(const TriangleMesh& mesh) {
  std::map<std::pair<std::int32_t, std::int32_t>, Vector3d> first;
  double sharpest = 1.0;
  for (Index f = 0; f < mesh.faces.rows(); ++f) {
    for (Index c = 0; c < 3; ++c) {
      const std::pair<std::int32_t, std::int32_t> edge =
          std::minmax({mesh.faces(f, c), mesh.faces(f, (c + 1) % 3)});
      const auto [entry, is_new] = first.try_emplace(edge, normal(mesh, f));
      if (!is_new) sharpest = std::min(sharpest, entry->second.dot(normal(mesh, f)));
    }
  }
  return sharpest;
}

// Shape-DNA by Weyl's law: the i-th eigenvalue at unit area over 4 pi i.
VectorXd dna(const TriangleMesh& mesh) {
  const Operator op = compute_operator(mesh);
  const VectorXd values = compute_spectrum(op, {.count = 31}).values.tail(30) * op.area;
  return values.array() / (4.0 * std::numbers::pi * VectorXd::LinSpaced(30, 1.0, 30.0).array());
}

// Made once for all tests of a species.
const CreatureBody& body_of(const std::string& species) {
  static std::map<std::string, CreatureBody> bodies;
  const auto known = bodies.find(species);
  if (known != bodies.end()) return known->second;
  return bodies.emplace(species, make_creature_body(species, {.vertices = 3500})).first->second;
}

class EverySpecies : public testing::TestWithParam<std::string> {
 protected:
  const CreatureBody& body_ = body_of(GetParam());
};

TEST_P(EverySpecies, IsASphereTurnedOutward) {
  const TriangleMesh& mesh = body_.skin.rest;
  const OrientedFaces oriented = orient_outward(mesh);
  EXPECT_EQ(oriented.orientation, Orientation::outward);
  EXPECT_EQ(oriented.faces, mesh.faces);
  EXPECT_EQ(2 * mesh.vertices.rows() - mesh.faces.rows(), 4);  // Euler characteristic 2
  EXPECT_EQ(compute_operator(mesh).component_area.size(), 1);
}

TEST_P(EverySpecies, HasAboutAsManyVerticesAsAskedAndGoodTriangles) {
  EXPECT_NEAR(static_cast<double>(body_.skin.rest.vertices.rows()), 3500.0, 350.0);
  const std::vector<double> angles = least_angles(body_.skin.rest);
  EXPECT_GT(angles.front(), 15.0);
  EXPECT_GT(angles[angles.size() / 100], 30.0);
}

TEST_P(EverySpecies, HasAnExactMirror) {
  const Points& points = body_.skin.rest.vertices;
  for (Index v = 0; v < points.rows(); ++v) {
    const std::int32_t image = body_.skin.mirror[static_cast<std::size_t>(v)];
    ASSERT_EQ(body_.skin.mirror[static_cast<std::size_t>(image)], v);
    ASSERT_EQ(points(image, 0), -points(v, 0));
    ASSERT_EQ(points(image, 1), points(v, 1));
    ASSERT_EQ(points(image, 2), points(v, 2));
  }
}

TEST_P(EverySpecies, WeightsArePartitionsOfOne) {
  EXPECT_GE(body_.skin.weights.minCoeff(), 0.0);
  EXPECT_LT((body_.skin.weights.rowwise().sum().array() - 1.0).abs().maxCoeff(), 1e-12);
}

TEST_P(EverySpecies, BendsWithoutMuchStretchOrFolds) {
  for (int pose = 1; pose < 6; ++pose) {
    const TriangleMesh posed = make_creature(body_, pose).mesh;
    const double stretch = mean_stretch(body_.skin.rest, posed);
    EXPECT_GT(stretch, 0.01) << "pose " << pose;
    EXPECT_LT(stretch, 0.09) << "pose " << pose;
    EXPECT_GT(sharpest_fold(posed), -0.8) << "pose " << pose;
    EXPECT_GT(least_angles(posed).front(), 2.0) << "pose " << pose;
  }
}

TEST_P(EverySpecies, IsTheSameEachTime) {
  const CreatureOptions options = {.seed = 7, .variation = 0.1, .shuffle = true};
  const auto bytes = [&](const CreatureBody& body, int pose) {
    return to_mesh_bytes(make_creature(body, pose, options).mesh, MeshFormat::ply);
  };
  const CreatureBody again = make_creature_body(GetParam(), {.vertices = 3500});
  EXPECT_EQ(bytes(body_, 3), bytes(again, 3));
  EXPECT_NE(bytes(body_, 3), bytes(body_, 4));
}
INSTANTIATE_TEST_SUITE_P(Species, EverySpecies, testing::ValuesIn(species_names()),
                         [](const auto& species) { return species.param; });

TEST(MakeCreature, ShufflesVerticesAndTellsWhere) {
  const CreatureBody body = make_creature_body("dog");
  const Creature plain = make_creature(body, 2);
  const Creature mixed = make_creature(body, 2, {.shuffle = true});
  const auto moved = [&](std::int32_t t) {
    return mixed.vertex_of_template[static_cast<std::size_t>(t)];
  };
  int unmoved = 0;
  for (std::int32_t t = 0; t < plain.mesh.vertices.rows(); ++t) {
    ASSERT_EQ(mixed.mesh.vertices.row(moved(t)), plain.mesh.vertices.row(t));
    ASSERT_EQ(mixed.mirror[static_cast<std::size_t>(moved(t))],
              moved(plain.mirror[static_cast<std::size_t>(t)]));
    unmoved += moved(t) == t ? 1 : 0;
  }
  EXPECT_LT(unmoved, 20);
  EXPECT_EQ(orient_outward(mixed.mesh).orientation, Orientation::outward);
  const VectorXd difference = dna(mixed.mesh) - dna(plain.mesh);
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-8);
}

TEST(MakeCreature, IndividualsDifferOnlyIfAsked) {
  const CreatureBody body = make_creature_body("horse");
  const auto stretch = [&](double variation) {
    return mean_stretch(body.skin.rest, make_creature(body, 3, {.variation = variation}).mesh);
  };
  EXPECT_LT(stretch(0.0), 0.05);
  EXPECT_GT(stretch(0.25), 0.08);
  EXPECT_EQ(make_creature(body, 0, {.variation = 0.25}).mesh.vertices, body.skin.rest.vertices);
}

TEST(MakeCreature, SpeciesSoundMoreDifferentThanPoses) {
  std::vector<VectorXd> spectra;
  for (const char* species : {"person", "horse", "ostrich"}) {
    const CreatureBody body = make_creature_body(species);
    for (const int pose : {1, 2}) spectra.push_back(dna(make_creature(body, pose).mesh));
  }
  double within = 0.0;
  double between = 1e9;
  for (std::size_t a = 0; a < spectra.size(); ++a) {
    for (std::size_t b = a + 1; b < spectra.size(); ++b) {
      const double distance = (spectra[a] - spectra[b]).norm();
      if (a / 2 == b / 2) within = std::max(within, distance);
      if (a / 2 != b / 2) between = std::min(between, distance);
    }
  }
  EXPECT_GT(between, 2.0 * within);
}

TEST(MakeCreature, RefusesWhatItCannotMake) {
  const auto complaint = [](const std::string& species, const CreatureOptions& options) {
    try {
      (void)make_creature(make_creature_body(species, options), 0, options);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no exception");
  };
  EXPECT_EQ(
      complaint("cow", {}),
      "species: no 'cow'; there are person, child, wrestler, gorilla, horse, dog, cat, giraffe, "
      "elephant, kangaroo, ostrich, lizard, octopus, ant");
  EXPECT_EQ(complaint("dog", {.vertices = 10}),
            "vertices: 10 asked for; 1000 to 50000 are possible");
  EXPECT_EQ(complaint("ant", {.vertices = 1000}),
            "vertices: 1000 are too few for the thin parts of 'ant'");
}

}  // namespace
}  // namespace timbre
