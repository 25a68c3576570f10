#include "timbre/matching/match.h"

#include <memory>
#include <utility>

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
  std::string source, target;
  int count = 200;
  bool strict = false;
};

std::string list(const std::vector<int>& numbers) {
  std::string text;
  for (const int number : numbers) text += (text.empty() ? "" : ", ") + std::to_string(number);
  return text;
}

// Flips of single functions share a line; the rest has one each.
std::string describe(const std::vector<Switch>& switches) {
  std::string flipped;
  std::string others;
  for (const Switch& item : switches) {
    if (item.kind == SwitchKind::flipped) {
      flipped += (flipped.empty() ? "" : ", ") + list(item.source);
      continue;
    }
    others += "  switch:     " + list(item.source);
    if (item.target.empty()) {
      others += " of the source has no counterpart\n";
    } else if (item.kind == SwitchKind::exchanged) {
      others += " of the source is " + list(item.target) + " of the target\n";
    } else {
      others += " together correspond to " + list(item.target) + " of the target\n";
    }
  }
  if (flipped.empty()) return others;
  return "  switch:     " + flipped + " appear with the other sign\n" + others;
}

std::string describe(const MatchSolution& solution) {
  return std::string(to_word(solution.orientation)) + ", energy " + to_text(solution.energy, 2) +
         ", coverage " + to_text(100.0 * solution.coverage, 0) + " %, confidence " +
         to_text(100.0 * solution.confidence, 0) + " %\n";
}

std::string to_prose(const Arguments& args, const MatchResult& result, const std::string& output) {
  std::string text = escape_control(args.source) + " -> " + escape_control(args.target) + ": " +
                     to_word(result.verdict);
  if (!result.reason.empty()) text += " (" + result.reason + ")";
  text += "\n";
  for (std::size_t i = 0; i < result.solutions.size(); ++i) {
    text += (i == 0 ? "  best map:   " : "  other map:  ") + describe(result.solutions[i]);
  }
  text += describe(result.switches);
  if (!output.empty() && output != "-") text += "  wrote " + escape_control(output) + "\n";
  return text;
}

nlohmann::json to_json(const MatchSolution& solution) {
  const MapEnergies& e = solution.energies;
  return {{"energy", solution.energy},
          {"orientation", to_word(solution.orientation)},
          {"coverage", solution.coverage},
          {"confidence", solution.confidence},
          {"terms",
           {{"geodesic", e.geodesic},
            {"bijectivity", e.bijectivity},
            {"coverage", e.coverage},
            {"commutation", e.commutation},
            {"stretch", e.stretch},
            {"curvature", e.curvature},
            {"products", e.products},
            {"areas", e.areas}}}};
}

nlohmann::json to_json(const Arguments& args, const MatchResult& result) {
  nlohmann::json solutions = nlohmann::json::array();
  for (const MatchSolution& solution : result.solutions) solutions.push_back(to_json(solution));
  nlohmann::json switches = nlohmann::json::array();
  for (const Switch& item : result.switches) {
    switches.push_back(
        {{"kind", to_word(item.kind)}, {"source", item.source}, {"target", item.target}});
  }
  return {{"source", args.source},
          {"target", args.target},
          {"verdict", to_word(result.verdict)},
          {"reason", result.reason},
          {"solutions", solutions},
          {"switches", switches},
          {"timings",
           {{"search", result.timings.search},
            {"samples", result.timings.samples},
            {"vertices", result.timings.vertices},
            {"dense", result.timings.dense}}}};
}

std::string map_bytes(const MatchResult& result, const std::string& output) {
  const std::string format = array_format(output);
  if (format == "npy") return to_npy_bytes(result.ab);
  if (format == "txt") return to_lines(result.ab);
  std::vector<NamedArray> arrays = {{"p2p_ab", to_npy_bytes(result.ab), true},
                                    {"p2p_ba", to_npy_bytes(result.ba), true}};
  if (!result.solutions.empty()) {
    arrays.push_back({"C_ab", to_npy(result.solutions[0].functional.ab)});
    arrays.push_back({"C_ba", to_npy(result.solutions[0].functional.ba)});
  }
  return to_archive(output, arrays);
}

void run(const Arguments& args, Context& context) {
  if (!context.output.empty()) (void)array_format(context.output);
  context.require_output();
  const MatchSurface A = load_surface(context, args.source, args.count);
  const MatchSurface B = load_surface(context, args.target, args.count);
  const MatchResult result =
      match(A, B, {.threads = context.threads, .progress = context.progress()});
  if (!context.output.empty()) {
    context.write_result(context.output, map_bytes(result, context.output));
  }
  if (args.strict && result.verdict != Verdict::clear) context.exit_code = 3;
  context.answer(to_json(args, result), to_prose(args, result, context.output));
}

}  // namespace

void add_match(CLI::App& timbre, Context& context) {
  auto args = std::make_shared<Arguments>();
  CLI::App& command = *timbre.add_subcommand("match", "Map one surface onto another");
  command.add_option("SOURCE", args->source, "mesh to map from")->required();
  command.add_option("TARGET", args->target, "mesh to map to")->required();
  command.add_option("-k,--count", args->count, "eigenfunctions used")
      ->capture_default_str()
      ->check(CLI::Range(30, 1000));
  command.add_flag("--strict", args->strict, "exit with 3 unless the verdict is clear");
  add_read_options(command, context);
  add_threads_option(command, context);
  add_common_options(command, context, true);
  command.footer(
      "MAP.txt and MAP.npy hold, for each vertex of SOURCE, the 0-based vertex of TARGET, -1 for\n"
      "none; MAP.npz both directions (p2p_ab, p2p_ba) and the functional maps (C_ab, C_ba). "
      "MAP.mat\n"
      "has the same, but counts vertices from 1, and 0 is none.\n"
      "Example:\n  timbre match standing.ply running.ply -o map.npz");
  command.callback([args, &context] { run(*args, context); });
}

}  // namespace timbre::cli
