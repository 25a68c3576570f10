#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "timbre/datasets/creatures.h"

namespace timbre {

/// What a folder of creatures holds.
enum class CreatureSet : std::uint8_t {
  shared,    ///< one triangulation for all poses of a species
  remeshed,  ///< each pose in triangles of its own, 0.7 to 1.5 times as many
  noise,     ///< remeshed, moved at random by half an edge
  holes,     ///< remeshed, six holes of 1.5 % of the area each
  cut,       ///< remeshed, 60 to 80 % left by a plane
  welded,    ///< remeshed, grown together where two limbs come near
  coarse,    ///< remeshed, a quarter of the vertices
  fine,      ///< remeshed, three times as many
};

[[nodiscard]] std::vector<CreatureSet> all_creature_sets();
[[nodiscard]] const char* to_word(CreatureSet set);

/// Whether a set has every pose; the others have one disturbed pose, pose 1, of each
/// species, beside pose 0 as in `remeshed`.
[[nodiscard]] bool holds_all_poses(CreatureSet set);

/// One shape of a set. Vertices that the disturbance took away are -1 in
/// `vertex_of_template` and `mirror`.
///
/// @throws Error  as `make_creature_body` and `retessellate` do
[[nodiscard]] Creature make_creature(const CreatureBody& body, CreatureSet set, int pose,
                                     const CreatureOptions& options = {});

/// For each vertex of `part` the vertex of `whole`, another creature of its species, that is
/// nearest on the body at rest.
[[nodiscard]] std::vector<std::int32_t> correspondence(const Creature& part, const Creature& whole);

}  // namespace timbre
