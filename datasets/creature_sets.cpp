#include "timbre/datasets/creature_sets.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "timbre/analysis/mesh/half_edge.h"
#include "timbre/datasets/detail/nearest_points.h"
#include "timbre/datasets/disturb.h"

namespace timbre {
namespace {

Random random_for(const char* topic, const CreatureBody& body, const CreatureOptions& options,
                  int pose) {
  return {topic + (" " + body.species), {options.seed, static_cast<std::uint64_t>(pose)}};
}

Creature remeshed(const CreatureBody& body, double factor, int pose,
                  const CreatureOptions& options) {
  Random random = random_for("tessellation", body, options, pose);
  const double drawn = random.uniform(0.7, 1.5);
  const double wanted = options.vertices * (factor > 0.0 ? factor : drawn);
  const int vertices = std::clamp(static_cast<int>(std::lround(wanted)), 1000, 50000);
  return make_creature(body, retessellate(body, vertices, random), pose, options);
}

void keep_part(Creature& creature, MeshPart part) {
  std::vector<std::int32_t> renumbered(creature.part.size(), -1);
  const Creature before = std::exchange(creature, Creature{});
  creature.species = before.species;
  creature.pose = before.pose;
  creature.mesh = std::move(part.mesh);
  creature.rest = before.rest(part.original, Eigen::all);
  for (std::size_t v = 0; v < part.original.size(); ++v) {
    const auto old = static_cast<std::size_t>(part.original[v]);
    renumbered[old] = static_cast<std::int32_t>(v);
    creature.part.push_back(before.part[old]);
  }
  for (const std::int32_t old : part.original) {
    const std::int32_t image = before.mirror[static_cast<std::size_t>(old)];
    creature.mirror.push_back(renumbered[static_cast<std::size_t>(image)]);
  }
  for (const std::int32_t old : before.vertex_of_template) {
    creature.vertex_of_template.push_back(renumbered[static_cast<std::size_t>(old)]);
  }
}

// A coarse mesh has no vertex at most points of the template, but always one near.
void keep_coarse(Creature& creature, DecimatedMesh coarse) {
  const Points from = creature.rest(creature.vertex_of_template, Eigen::all);
  keep_part(creature, {std::move(coarse.mesh), std::move(coarse.original)});
  creature.vertex_of_template = detail::nearest_points(from, creature.rest);
  Points image = creature.rest;
  image.col(0) *= -1.0;
  creature.mirror = detail::nearest_points(image, creature.rest);
}

}  // namespace

std::vector<CreatureSet> all_creature_sets() {
  return {CreatureSet::shared, CreatureSet::remeshed, CreatureSet::noise,  CreatureSet::holes,
          CreatureSet::cut,    CreatureSet::welded,   CreatureSet::coarse, CreatureSet::fine};
}

const char* to_word(CreatureSet set) {
  switch (set) {
    case CreatureSet::shared:
      return "shared";
    case CreatureSet::remeshed:
      return "remeshed";
    case CreatureSet::noise:
      return "noise";
    case CreatureSet::holes:
      return "holes";
    case CreatureSet::cut:
      return "cut";
    case CreatureSet::welded:
      return "welded";
    case CreatureSet::coarse:
      return "coarse";
    default:
      return "fine";
  }
}

bool holds_all_poses(CreatureSet set) {
  return set == CreatureSet::shared || set == CreatureSet::remeshed;
}

Creature make_creature(const CreatureBody& body, CreatureSet set, int pose,
                       const CreatureOptions& options) {
  if (set == CreatureSet::shared) return make_creature(body, pose, options);
  if (set == CreatureSet::fine && pose > 0) return remeshed(body, 3.0, pose, options);
  Creature creature = remeshed(body, 0.0, pose, options);
  if (holds_all_poses(set) || pose == 0) return creature;
  Random random = random_for(to_word(set), body, options, pose);
  if (set == CreatureSet::noise) creature.mesh = add_noise(creature.mesh, 0.5, random);
  if (set == CreatureSet::welded) creature.mesh = weld_contact(creature.mesh);
  if (set == CreatureSet::holes) {
    keep_part(creature, punch_holes(creature.mesh, 6, 0.015, random));
  }
  if (set == CreatureSet::cut) {
    keep_part(creature, cut_by_plane(creature.mesh, random.uniform(0.6, 0.8), random));
  }
  if (set == CreatureSet::coarse) {
    const auto quarter = static_cast<std::int32_t>(creature.part.size() / 4);
    keep_coarse(creature, decimate(creature.mesh, quarter));
  }
  return creature;
}

std::vector<std::int32_t> correspondence(const Creature& part, const Creature& whole) {
  return detail::nearest_points(part.rest, whole.rest);
}

}  // namespace timbre
