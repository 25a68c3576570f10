#include "timbre/matching/symmetry.h"

#include <memory>

#include "timbre/analysis/core/array_file.h"
#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"
#include "timbre/cli/array_output.h"
#include "timbre/cli/commands/map_input.h"
#include "timbre/cli/commands/map_output.h"
#include "timbre/cli/options.h"

namespace timbre::cli {
namespace {

struct Arguments {
  std::string mesh;
  int count = 200;
};

std::string to_prose(const Arguments& args, const std::vector<Reflection>& found,
                     const std::string& output) {
  if (found.empty()) return escape_control(args.mesh) + ": no reflection found\n";
  std::string text = escape_control(args.mesh) + ": " + std::to_string(found.size()) +
                     " candidate" + (found.size() == 1 ? "" : "s") +
                     " for a reflection, best first\n";
  for (const Reflection& reflection : found) {
    text += "  energy " + to_text(reflection.energy, 3) + ", confidence " +
            to_text(100.0 * reflection.confidence, 0) + " %" + ", mean displacement " +
            to_text(reflection.displacement, 2) + "\n";
  }
  if (!output.empty() && output != "-") text += "  wrote " + escape_control(output) + "\n";
  return text;
}

nlohmann::json to_json(const Arguments& args, const std::vector<Reflection>& found) {
  nlohmann::json maps = nlohmann::json::array();
  for (const Reflection& reflection : found) {
    maps.push_back({{"kind", "reflection"},
                    {"energy", reflection.energy},
                    {"confidence", reflection.confidence},
                    {"displacement", reflection.displacement},
                    {"involution_error", reflection.involution},
                    {"geodesic", reflection.energies.geodesic}});
  }
  return {{"mesh", args.mesh}, {"maps", maps}};
}

std::string map_bytes(const std::vector<Reflection>& found, const std::string& output) {
  const std::string format = array_format(output);
  if (format == "npy") return to_npy_bytes(found[0].map);
  if (format == "txt") return to_lines(found[0].map);
  std::vector<NamedArray> arrays;
  for (std::size_t i = 0; i < found.size(); ++i) {
    arrays.push_back({"map_" + std::to_string(i), to_npy_bytes(found[i].map), true});
    arrays.push_back({"C_" + std::to_string(i), to_npy(found[i].C)});
  }
  return to_archive(output, arrays);
}

void run(const Arguments& args, const Context& context) {
  if (!context.output.empty()) (void)array_format(context.output);
  context.require_output();
  const MatchSurface surface = load_surface(context, args.mesh, args.count);
  const std::vector<Reflection> found =
      find_reflections(surface, {.threads = context.threads, .progress = context.progress()});
  if (!context.output.empty()) {
    if (found.empty()) {
      throw Error(ErrorKind::not_converged, args.mesh, "symmetry",
                  "no reflection found, so there is no map to write");
    }
    context.write_result(context.output, map_bytes(found, context.output));
  }
  context.answer(to_json(args, found), to_prose(args, found, context.output));
}

}  // namespace

void add_symmetry(CLI::App& timbre, Context& context) {
  auto args = std::make_shared<Arguments>();
  CLI::App& command = *timbre.add_subcommand("symmetry", "Reflections of a shape onto itself");
  command.add_option("MESH", args->mesh, "mesh file, or - for standard input")->required();
  command.add_option("-k,--count", args->count, "eigenfunctions used")
      ->capture_default_str()
      ->check(CLI::Range(30, 1000));
  add_read_options(command, context);
  add_threads_option(command, context);
  add_common_options(command, context, true);
  command.footer(
      "MAP.txt and MAP.npy hold the best reflection: for each vertex the 0-based vertex of its\n"
      "mirror image; MAP.npz all of them (map_0, C_0, map_1, ...);\n"
      "MAP.mat, too, and counts vertices from 1.\n"
      "Example:\n  timbre symmetry horse.ply -o mirror.txt");
  command.callback([args, &context] { run(*args, context); });
}

}  // namespace timbre::cli
