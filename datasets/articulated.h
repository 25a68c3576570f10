#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"
#include "timbre/datasets/skeleton.h"
#include "timbre/datasets/species.h"

namespace timbre {

struct ArticulatedOptions {
  /// Vertices of a mesh, met within a few per cent. Fewer than about 3,000 may not
  /// resolve the thin limbs of some species; legal are 1,000 to 50,000.
  int vertices = 3500;
  std::uint64_t seed = 1;  ///< of poses, proportions and shuffling
  double variation = 0.0;  ///< proportions differ by up to this share from seed to seed; below 0.3
  bool shuffle = false;    ///< vertices and faces in random order, another for each pose
};

/// A creature at rest, ready to be posed: closed, manifold, of genus 0, oriented outward,
/// and exactly symmetric under x -> -x.
struct ArticulatedBody {
  std::string species;
  Skeleton skeleton;
  TriangleMesh rest;
  std::vector<std::int32_t> mirror;  ///< n, an involution: the left-right image of a vertex
  Eigen::MatrixXd weights;           ///< n x bones, non-negative, rows sum to 1
};

/// One pose of a creature.
struct ArticulatedShape {
  TriangleMesh mesh;
  /// n, which vertex of `mesh` is vertex t of the body at rest; 0, 1, ... unless shuffled.
  std::vector<std::int32_t> vertex_of_template;
  std::vector<std::int32_t> mirror;  ///< n, left-right image of each vertex of `mesh`
  std::string species;
  int pose = 0;
};

/// Skins the skeleton of a species. Weights are heat that each bone sends into the skin
/// next to it.
///
/// @throws Error  bad_request for an unknown species or options out of range; bad_input
///                if `vertices` are too few for the body's thinnest parts
/// @see Baran and Popovic 2007, section 4 (weights)
[[nodiscard]] ArticulatedBody make_articulated_body(const std::string& species,
                                                    const ArticulatedOptions& options = {});

/// Pose 0 is the body at rest; others are drawn from (species, pose, seed), so that a
/// pose does not depend on which others are made.
[[nodiscard]] ArticulatedShape make_articulated(const ArticulatedBody& body, int pose,
                                                const ArticulatedOptions& options = {});

/// Both steps in one. To make several poses, keep the body.
[[nodiscard]] ArticulatedShape make_articulated(const std::string& species, int pose,
                                                const ArticulatedOptions& options = {});

}  // namespace timbre
