#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/output_file.h"
#include "timbre/analysis/core/threads.h"
#include "timbre/cli/command.h"
#include "timbre/cli/commands/dataset.h"
#include "timbre/cli/options.h"
#include "timbre/datasets/creature_sets.h"

namespace timbre::cli {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::vector<std::string> species = species_names();
  std::vector<CreatureSet> sets = all_creature_sets();
  int poses = 10;
  std::string format = "ply";
  CreatureOptions options = {.variation = 0.25, .shuffle = true};
};

void require_free_folder(const Context& context) {
  if (context.output == "-") {
    throw Error(ErrorKind::bad_request, "", "output", "a folder is needed, not standard output");
  }
  std::error_code failure;
  if (context.force || !fs::exists(context.output, failure)) return;
  const bool empty =
      fs::is_directory(context.output, failure) && fs::is_empty(context.output, failure);
  if (failure) throw Error(ErrorKind::io, context.output, "", failure.message());
  if (!empty) {
    throw Error(ErrorKind::bad_request, context.output, "",
                "is there already, and no empty folder; --force lets files in it be replaced");
  }
}

fs::path create_folder(const Context& context, CreatureSet set) {
  fs::path folder = fs::path(context.output) / to_word(set);
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) throw Error(ErrorKind::io, folder.string(), "", failure.message());
  require_writable((folder / "labels.txt").string(), context.force);
  // The list of what was there before would vouch for shapes that are half replaced.
  fs::remove(folder / "labels.txt", failure);
  return folder;
}

// One vertex a line.
std::string lines_of(const std::vector<std::int32_t>& vertices, std::int32_t first) {
  std::string text;
  for (const std::int32_t v : vertices) text += std::to_string(v + first) + '\n';
  return text;
}

// A column for each species; 0 where one has fewer vertices than another.
std::string symmetry_table(const std::vector<CreatureBody>& bodies) {
  std::string text;
  std::size_t rows = 0;
  for (const CreatureBody& body : bodies) {
    text += (text.empty() ? "" : " ") + body.species;
    rows = std::max(rows, body.skin.mirror.size());
  }
  text += "\n";
  for (std::size_t t = 0; t < rows; ++t) {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const std::vector<std::int32_t>& mirror = bodies[b].skin.mirror;
      if (b > 0) text += ' ';
      text += std::to_string(t < mirror.size() ? mirror[t] + 1 : 0);
    }
    text += '\n';
  }
  return text;
}

std::string part_table(const std::vector<CreatureBody>& bodies) {
  std::string text;
  for (const CreatureBody& body : bodies) {
    for (std::size_t b = 0; b < body.skeleton.bones.size(); ++b) {
      text += body.species + ' ' + std::to_string(b) + ' ' + body.skeleton.bones[b].name + '\n';
    }
  }
  return text;
}

std::string name_of(const std::string& species, int pose) { return species + std::to_string(pose); }

// All pairs of poses of one species, in random order, so that the first lines are a fair
// sample. A disturbed shape always goes onto the whole one.
std::string pair_lines(const Arguments& args, CreatureSet set) {
  Random random(std::string("pairs ") + to_word(set), {args.options.seed});
  std::vector<std::string> lines;
  const auto file = [&](const std::string& species, int pose) {
    return name_of(species, pose) + "." + args.format;
  };
  const int poses = holds_all_poses(set) ? args.poses : 2;
  for (const std::string& species : args.species) {
    for (int a = 0; a < poses; ++a) {
      for (int b = a + 1; b < poses; ++b) {
        const bool turned = !holds_all_poses(set) || random.uniform(0.0, 1.0) < 0.5;
        lines.push_back(file(species, turned ? b : a) + " " + file(species, turned ? a : b) + "\n");
      }
    }
  }
  std::string text;
  for (const std::int32_t i : random.permutation(static_cast<std::int32_t>(lines.size()))) {
    text += lines[static_cast<std::size_t>(i)];
  }
  return text;
}

std::vector<CreatureBody> make_bodies(const Arguments& args, const Context& context) {
  std::vector<CreatureBody> bodies(args.species.size());
  SharedProgress shared(context.progress(), "bodies", static_cast<std::int64_t>(bodies.size()));
  parallel_for(static_cast<std::int64_t>(bodies.size()), context.threads, [&](std::int64_t i) {
    const auto at = static_cast<std::size_t>(i);
    bodies[at] = make_creature_body(args.species[at], args.options);
    shared.finish_one();
  });
  return bodies;
}

struct Task {
  CreatureSet set;
  const CreatureBody* body;
  int pose;
};

std::vector<Task> tasks_of(const Arguments& args, const std::vector<CreatureBody>& bodies) {
  std::vector<Task> tasks;
  for (const CreatureSet set : args.sets) {
    for (const CreatureBody& body : bodies) {
      const int poses = holds_all_poses(set) ? args.poses : 2;
      for (int pose = 0; pose < poses; ++pose) tasks.push_back({set, &body, pose});
    }
  }
  return tasks;
}

nlohmann::json write_shape(const Task& task, const Arguments& args, const Context& context) {
  const Creature creature = make_creature(*task.body, task.set, task.pose, args.options);
  const std::string name = name_of(creature.species, creature.pose);
  const fs::path folder = to_word(task.set);
  const std::string stem = (context.output / folder / name).string();
  context.write_result(stem + "." + args.format,
                       to_mesh_bytes(creature.mesh, mesh_formats().at(args.format)));
  context.write_result(stem + ".vts", lines_of(creature.vertex_of_template, 1));
  context.write_result(stem + ".parts", lines_of(creature.part, 0));
  if (task.set == CreatureSet::cut && task.pose > 0) {
    const Creature whole = make_creature(*task.body, task.set, 0, args.options);
    context.write_result(stem + ".map", lines_of(correspondence(creature, whole), 0));
  }
  return {{"file", (folder / (name + "." + args.format)).string()},
          {"set", to_word(task.set)},
          {"truth", (folder / (name + ".vts")).string()},
          {"species", creature.species},
          {"pose", creature.pose},
          {"vertices", creature.mesh.vertices.rows()},
          {"faces", creature.mesh.faces.rows()}};
}

std::vector<nlohmann::json> write_shapes(const Arguments& args, const Context& context,
                                         const std::vector<CreatureBody>& bodies) {
  const std::vector<Task> tasks = tasks_of(args, bodies);
  std::vector<nlohmann::json> written(tasks.size());
  SharedProgress shared(context.progress(), "shapes", static_cast<std::int64_t>(written.size()));
  parallel_for(static_cast<std::int64_t>(written.size()), context.threads, [&](std::int64_t i) {
    const auto at = static_cast<std::size_t>(i);
    written[at] = write_shape(tasks[at], args, context);
    shared.finish_one();
  });
  return written;
}

// FILE SPECIES POSE of each shape of a set.
std::string label_lines(const std::vector<nlohmann::json>& shapes, CreatureSet set) {
  std::string text;
  for (const nlohmann::json& shape : shapes) {
    if (shape["set"] != to_word(set)) continue;
    text += fs::path(shape["file"].get<std::string>()).filename().string() + ' ' +
            shape["species"].get<std::string>() + ' ' + shape["pose"].dump() + '\n';
  }
  return text;
}

void require_distinct(std::vector<std::string> words, const char* option) {
  std::sort(words.begin(), words.end());
  const auto twice = std::adjacent_find(words.begin(), words.end());
  if (twice == words.end()) return;
  throw Error(ErrorKind::bad_request, "", option, "'" + *twice + "' is named twice");
}

void make_creatures(const Arguments& args, const Context& context) {
  require_distinct(args.species, "species");
  std::vector<std::string> sets;
  for (const CreatureSet set : args.sets) sets.emplace_back(to_word(set));
  require_distinct(sets, "sets");
  require_free_folder(context);
  std::vector<fs::path> folders;
  for (const CreatureSet set : args.sets) folders.push_back(create_folder(context, set));
  const std::vector<CreatureBody> bodies = make_bodies(args, context);
  const std::vector<nlohmann::json> shapes = write_shapes(args, context, bodies);
  for (std::size_t i = 0; i < folders.size(); ++i) {
    const fs::path& folder = folders[i];
    const CreatureSet set = args.sets[i];
    context.write_result((folder / "symmetry.txt").string(), symmetry_table(bodies));
    context.write_result((folder / "parts.txt").string(), part_table(bodies));
    context.write_result((folder / "pairs.txt").string(), pair_lines(args, set));
    // Last the list of shapes: where it is, all it lists is there.
    context.write_result((folder / "labels.txt").string(), label_lines(shapes, set));
  }
  context.answer({{"folder", context.output}, {"sets", sets}, {"shapes", shapes}},
                 "wrote " + std::to_string(shapes.size()) + " shapes to " +
                     escape_control(context.output) + "\n");
}

void add_sets_option(CLI::App& command, std::vector<CreatureSet>& sets) {
  std::map<std::string, CreatureSet> known;
  std::vector<std::string> words;
  for (const CreatureSet set : all_creature_sets()) {
    known.emplace(to_word(set), set);
    words.emplace_back(to_word(set));
  }
  const auto take = [&sets, known](const std::vector<std::string>& given) {
    sets.clear();
    for (const std::string& word : given) sets.push_back(known.at(word));
  };
  command
      .add_option_function<std::vector<std::string>>("--sets", take,
                                                     "folders to make, comma-separated")
      ->delimiter(',')
      ->check(CLI::IsMember(words))
      ->default_str("all");
}

}  // namespace

const std::map<std::string, MeshFormat>& mesh_formats() {
  static const std::map<std::string, MeshFormat> kFormats = {
      {"ply", MeshFormat::ply}, {"off", MeshFormat::off}, {"obj", MeshFormat::obj}};
  return kFormats;
}

void add_make_creatures(CLI::App& make, Context& context) {
  auto args = std::make_shared<Arguments>();
  CLI::App& command = *make.add_subcommand("creatures", "Animals and people in poses, with truth");
  command.add_option("--species", args->species, "which creatures, comma-separated")
      ->delimiter(',')
      ->capture_default_str();
  command.add_option("--poses", args->poses, "poses of each; pose 0 is the creature at rest")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  add_sets_option(command, args->sets);
  command.add_option("--resolution", args->options.vertices, "about how many vertices a shape has")
      ->check(CLI::Range(1000, 50000))
      ->capture_default_str();
  command.add_option("--seed", args->options.seed, "of poses, builds and triangulations")
      ->capture_default_str();
  command
      .add_option("--variation", args->options.variation,
                  "share by which bones of individuals differ; 0: one individual a species")
      ->check(number_between(0.0, 0.35))
      ->capture_default_str();
  command.add_flag("!--no-shuffle", args->options.shuffle,
                   "in 'shared', keep one vertex order over the poses of a species");
  command.add_option("--format", args->format, "of the meshes: ply, off or obj")
      ->check(CLI::IsMember({"ply", "off", "obj"}))
      ->capture_default_str();
  add_threads_option(command, context);
  add_common_options(command, context, true);
  command.get_option("--output")->required()->description("folder for the sets");
  command.footer(
      "A set is a folder: SPECIESpose meshes, their truth (.vts: line i = vertex for point i of\n"
      "the species, from 1, 0 = none), .parts (number of the bone of each vertex, names in\n"
      "parts.txt), labels.txt, pairs.txt, symmetry.txt. 'remeshed' is the one to measure by.\n"
      "Example:\n  timbre dataset make creatures -o creatures --species horse,dog --poses 4");
  command.callback([args, &context] { make_creatures(*args, context); });
}

}  // namespace timbre::cli
