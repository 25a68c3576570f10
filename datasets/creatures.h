#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"
#include "timbre/datasets/random.h"
#include "timbre/datasets/skeleton.h"
#include "timbre/datasets/species.h"

namespace timbre {

struct CreatureOptions {
  /// Vertices of a mesh, met within a few per cent. Fewer than about 3,000 may not
  /// resolve the thin limbs of some species; legal are 1,000 to 50,000.
  int vertices = 5000;
  std::uint64_t seed = 1;  ///< of poses, builds, tessellations and vertex order
  /// Every pose but pose 0 is another individual: its bones are longer and thicker than the
  /// species's by factors within this share. 0: the same individual in all poses; below 0.4.
  double variation = 0.0;
  bool shuffle = false;  ///< vertices and faces in random order, another for each pose
};

/// A triangulation of a body at rest, ready to be posed. All of a body lie on one surface,
/// whose points its first triangulation, the template, numbers.
struct CreatureSkin {
  TriangleMesh rest;        ///< closed, manifold, of genus 0, oriented outward
  Eigen::MatrixXd weights;  ///< n x bones, non-negative, rows sum to 1
  /// For each vertex of the template the nearest vertex here.
  std::vector<std::int32_t> vertex_of_template;
  /// n, the vertex nearest to the left-right image of each vertex.
  std::vector<std::int32_t> mirror;
};

/// A species at rest.
struct CreatureBody {
  std::string species;
  Skeleton skeleton;
  /// The template: exactly symmetric under x -> -x, `mirror` is an involution and
  /// `vertex_of_template` counts 0, 1, ...
  CreatureSkin skin;
  double cell = 0.0;  ///< spacing of the lattice that cut the template
};

/// One pose of a creature.
struct Creature {
  TriangleMesh mesh;
  std::vector<std::int32_t> vertex_of_template;  ///< as in `CreatureSkin`
  std::vector<std::int32_t> mirror;              ///< n, likewise
  std::vector<std::int32_t> part;                ///< n, the bone that moves a vertex most
  Points rest;  ///< n x 3, where the vertex lies on the species at rest: the exact truth
  std::string species;
  int pose = 0;
};

/// Skins the skeleton of a species. Weights are heat that each bone sends into the skin
/// next to it.
///
/// @throws Error  bad_request for an unknown species or options out of range; bad_input
///                if `vertices` are too few for the body's thinnest parts
/// @see Baran and Popovic 2007, section 4 (weights)
[[nodiscard]] CreatureBody make_creature_body(const std::string& species,
                                              const CreatureOptions& options = {});

/// The same surface in triangles of its own, not symmetric, of about `vertices` vertices.
///
/// Truth between tessellations is as good as their nearest vertices: half an edge.
/// @throws Error  bad_request and bad_input as `make_creature_body` does
[[nodiscard]] CreatureSkin retessellate(const CreatureBody& body, int vertices, Random& random);

/// Pose 0 is the body at rest; others are drawn from (species, pose, seed), so that a
/// pose does not depend on which others are made, nor on the tessellation.
///
/// @param skin  of this body
[[nodiscard]] Creature make_creature(const CreatureBody& body, const CreatureSkin& skin, int pose,
                                     const CreatureOptions& options = {});

/// The same on the body's template.
[[nodiscard]] Creature make_creature(const CreatureBody& body, int pose,
                                     const CreatureOptions& options = {});

}  // namespace timbre
