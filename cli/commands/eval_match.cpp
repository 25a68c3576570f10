#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"
#include "timbre/cli/commands/eval.h"
#include "timbre/cli/commands/map_judge.h"
#include "timbre/cli/commands/result_log.h"
#include "timbre/cli/options.h"
#include "timbre/cli/version.h"

namespace timbre::cli {
namespace {

struct Arguments {
  std::vector<std::string> inputs;
  JudgeOptions judge;
  int number = 0;
};

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kCurveStep = 0.5;
constexpr int kCurvePoints = 51;  // errors 0, 0.5, ..., 25

nlohmann::json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

nlohmann::json to_json(const Judged& judged) {
  const MapScore& score = judged.score;
  nlohmann::json curve = nlohmann::json::array();
  for (int i = 0; i < kCurvePoints; ++i) curve.push_back(score.share_below(kCurveStep * i));
  nlohmann::json flipped;  // null where nothing is known or answered
  if (std::isfinite(score.mean_error) && std::isfinite(judged.mirrored_error.value_or(kNaN))) {
    flipped = *judged.mirrored_error < score.mean_error;
  }
  nlohmann::json line = judged.made;
  line.update({{"source", judged.source},
               {"target", judged.target},
               {"error", number_or_null(score.mean_error)},
               {"below5", score.below5},
               {"matched", score.matched},
               {"found", score.found},
               {"rows", score.rows},
               {"flipped", flipped},
               {"right", score.share_below(kSymmetryError)},
               {"pck", curve}});
  return line;
}

std::vector<std::pair<std::string, std::string>> work_of(const Arguments& args,
                                                         const ShapeSet& set) {
  std::vector<std::pair<std::string, std::string>> work = set.pairs;
  if (args.judge.kind == TruthKind::symmetry) {
    work.clear();
    for (const SetShape& shape : set.shapes) {
      if (has_symmetry_truth(set, shape)) work.emplace_back(shape.name, shape.name);
    }
  }
  if (args.number > 0) work.resize(std::min(work.size(), static_cast<std::size_t>(args.number)));
  if (work.empty()) {
    throw Error(
        ErrorKind::bad_input, set.folder, "",
        args.judge.kind == TruthKind::map ? "holds no pair" : "holds no shape of known symmetry");
  }
  return work;
}

std::string row(const nlohmann::json& pair) {
  const std::string verdict = pair.value("verdict", "");
  const auto text = [](const nlohmann::json& value, double factor, int digits) {
    return value.is_null() ? std::string("-") : to_text(factor * value.get<double>(), digits);
  };
  return pair["source"].get<std::string>() + " -> " + pair["target"].get<std::string>() +
         ": error " + text(pair["error"], 1.0, 2) + ", " + text(pair["below5"], 100.0, 1) +
         " % within 5, " + text(pair["matched"], 100.0, 0) + " % answered" +
         (pair["found"].get<bool>() ? "" : ", not found") + (verdict.empty() ? "" : ", " + verdict);
}

// Means over pairs, each of the same weight.
nlohmann::json summary(const std::vector<nlohmann::json>& pairs, TruthKind kind) {
  const auto n = static_cast<double>(pairs.size());
  double error = 0.0, found_error = 0.0, matched = 0.0, found = 0.0, answered = 0.0, right = 0.0;
  double meshes = 0.0, flipped = 0.0, sided = 0.0;
  std::vector<double> curve(kCurvePoints, 0.0);
  std::vector<double> thresholds(kCurvePoints);
  for (int i = 0; i < kCurvePoints; ++i) thresholds[static_cast<std::size_t>(i)] = kCurveStep * i;
  std::map<std::string, std::array<int, 2>> verdicts;
  for (const nlohmann::json& pair : pairs) {
    const bool is_found = pair["found"].get<bool>();
    if (!pair["error"].is_null()) {
      ++answered;
      error += pair["error"].get<double>();
      if (is_found) found_error += pair["error"].get<double>();
    }
    found += is_found ? 1.0 : 0.0;
    if (!pair["flipped"].is_null()) {
      ++sided;
      flipped += pair["flipped"].get<bool>() ? 1.0 : 0.0;
    }
    matched += pair["matched"].get<double>() / n;
    right += pair["right"].get<double>() / n;
    meshes += pair["right"].get<double>() > kSymmetryShare ? 1.0 / n : 0.0;
    for (std::size_t i = 0; i < curve.size(); ++i) curve[i] += pair["pck"][i].get<double>() / n;
    if (pair.contains("verdict")) ++verdicts[pair["verdict"].get<std::string>()][is_found ? 0 : 1];
  }
  nlohmann::json document = {{"mean_error", number_or_null(error / answered)},
                             {"mean_error_of_found", number_or_null(found_error / found)},
                             {"found", found / n},
                             {"matched", matched},
                             {"flipped", number_or_null(flipped / sided)},
                             {"pck", {{"error", thresholds}, {"share", curve}}},
                             {"pairs", pairs}};
  nlohmann::json doubt = nlohmann::json::object();
  for (const auto& [word, counts] : verdicts) {
    doubt[word] = {{"found", counts[0]}, {"not_found", counts[1]}};
  }
  document["verdicts"] = doubt;
  if (kind == TruthKind::symmetry) {
    document["mesh_rate"] = meshes;
    document["correspondence_rate"] = right;
  }
  return document;
}

std::string to_prose(const nlohmann::json& document, std::size_t pairs) {
  const auto percent = [&](const char* field) {
    return to_text(100.0 * document[field].get<double>(), 1) + " %";
  };
  const auto error = [&](const char* field) {
    return document[field].is_null() ? std::string("-") : to_text(document[field].get<double>(), 2);
  };
  std::string text = std::to_string(pairs) + (pairs == 1 ? " map" : " maps") + ": mean error " +
                     error("mean_error") + ", found " + percent("found") +
                     " (mean error of these " + error("mean_error_of_found") + "), answered " +
                     percent("matched") + "\n";
  if (!document["flipped"].is_null()) {
    text += "left and right exchanged: " + percent("flipped") + "\n";
  }
  for (const auto& [word, counts] : document["verdicts"].items()) {
    text += "verdict " + word + ": " + counts["found"].dump() + " found, " +
            counts["not_found"].dump() + " not\n";
  }
  if (document.contains("mesh_rate")) {
    text += "symmetry: mesh rate " + percent("mesh_rate") + ", correspondence rate " +
            percent("correspondence_rate") + "\n";
  }
  return text;
}

// Maps that are given were made by no method of ours.
nlohmann::json method_of(const Arguments& args) {
  if (!args.judge.maps.empty() || args.inputs.size() > 1) return {};
  return args.judge.method == MatchMethod::tensor ? "tensor" : "functional";
}

nlohmann::json parameters(const Arguments& args, const Context& context) {
  return {
      {"set", args.inputs.front()},
      {"kind", args.judge.kind == TruthKind::map ? "map" : "sym"},
      {"geodesic", args.judge.geodesic == GeodesicKind::exact ? "exact" : "graph"},
      {"maps", args.judge.maps.empty() ? nlohmann::json() : nlohmann::json(args.judge.maps)},
      {"save_maps", args.judge.save.empty() ? nlohmann::json() : nlohmann::json(args.judge.save)},
      {"method", method_of(args)},
      {"count", args.judge.count},
      {"samples", args.judge.samples},
      {"soup", context.read.soup},
      {"version", version_text()}};
}

void create_map_folder(const std::string& folder) {
  std::error_code failure;
  if (!folder.empty()) std::filesystem::create_directories(folder, failure);
  if (failure) throw Error(ErrorKind::io, folder, "", failure.message());
}

// What an interrupted run left may have been edited.
bool is_whole(const nlohmann::json& result) {
  const auto holds = [&](const char* field, bool (nlohmann::json::*is)() const noexcept) {
    return result.contains(field) && (result[field].*is)();
  };
  const auto holds_number_or_null = [&](const char* field) {
    return result.contains(field) && (result[field].is_number() || result[field].is_null());
  };
  bool is_right = holds("source", &nlohmann::json::is_string) &&
                  holds("target", &nlohmann::json::is_string) && holds_number_or_null("error") &&
                  holds("found", &nlohmann::json::is_boolean) && result.contains("flipped") &&
                  (result["flipped"].is_boolean() || result["flipped"].is_null()) &&
                  holds("pck", &nlohmann::json::is_array) && result["pck"].size() == kCurvePoints;
  is_right = is_right && (!result.contains("verdict") || result["verdict"].is_string());
  for (const char* field : {"below5", "matched", "right"}) {
    is_right = is_right && holds(field, &nlohmann::json::is_number);
  }
  return is_right && std::all_of(result["pck"].begin(), result["pck"].end(),
                                 [](const nlohmann::json& share) { return share.is_number(); });
}

std::vector<nlohmann::json> judge_set(const Arguments& args, const Context& context) {
  const ShapeSet set = read_shape_set(args.inputs.front());
  const auto work = work_of(args, set);
  create_map_folder(args.judge.save);
  std::optional<ResultLog> log;
  if (!context.output.empty()) {
    log.emplace(context.output, parameters(args, context), context.force);
    if (log->kept() > 0) {
      context.note(escape_control(context.output) + ": goes on after " +
                   std::to_string(log->kept()) + " results");
    }
  }
  JudgeOptions options = args.judge;
  options.goes_on = log && log->was_there();
  MapJudge judge(options, context);
  std::vector<nlohmann::json> pairs;
  for (const auto& [source, target] : work) {
    if (interrupted()) throw Error(ErrorKind::cancelled, "", "maps", "stopped on request");
    const std::string key = (std::filesystem::path(source) / target).string();
    std::optional<nlohmann::json> known = log ? log->find(key) : std::nullopt;
    if (known && !is_whole(*known)) {
      if (!context.force) {
        throw Error(ErrorKind::bad_request, context.output, "",
                    "holds a line that is no result; --force makes it again");
      }
      known.reset();
    }
    if (!known) {
      known = to_json(judge.judge_pair(set, source, target));
      if (log) log->append(key, *known);
    }
    pairs.push_back(*known);
    context.note("[" + std::to_string(pairs.size()) + "/" + std::to_string(work.size()) + "] " +
                 escape_control(row(*known)));
  }
  return pairs;
}

bool is_set(const Arguments& args) { return args.inputs.size() == 1; }

void require_sense(const Arguments& args, const Context& context) {
  const std::size_t single = args.judge.kind == TruthKind::map ? 3 : 2;
  if (args.inputs.size() != 1 && args.inputs.size() != single) {
    throw Error(ErrorKind::bad_request, "", "inputs",
                args.judge.kind == TruthKind::map ? "give SET, or SOURCE TARGET MAP"
                                                  : "give SET, or MESH MAP");
  }
  if (is_set(args) && !args.judge.truth.empty()) {
    throw Error(ErrorKind::bad_request, "", "truth", "is of one map; a set has its own");
  }
  if (!is_set(args) && (!args.judge.maps.empty() || !args.judge.save.empty() ||
                        !context.output.empty() || args.number > 0)) {
    throw Error(ErrorKind::bad_request, "", "inputs",
                "--maps, --save-maps, -n and -o are for sets");
  }
}

void run(const Arguments& args, Context& context) {
  require_sense(args, context);
  std::vector<nlohmann::json> pairs;
  if (is_set(args)) {
    pairs = judge_set(args, context);
  } else {
    const std::string& source = args.inputs.front();
    const std::string& target = args.judge.kind == TruthKind::map ? args.inputs[1] : source;
    pairs.push_back(
        to_json(MapJudge(args.judge, context).judge_file(source, target, args.inputs.back())));
  }
  nlohmann::json document = summary(pairs, args.judge.kind);
  document["geodesic"] = parameters(args, context)["geodesic"];
  document["method"] = method_of(args);
  context.answer(document, (is_set(args) ? "" : escape_control(row(pairs[0])) + "\n") +
                               to_prose(document, pairs.size()));
}

}  // namespace

void add_eval_match(CLI::App& eval, Context& context) {
  auto args = std::make_shared<Arguments>();
  CLI::App& command = *eval.add_subcommand("match", "How right are maps? One, or those of a set");
  command
      .add_option(
          "INPUTS", args->inputs,
          "a folder of shapes with truth, or SOURCE TARGET MAP (with --kind sym: MESH MAP);\n"
          "a map is text, a vertex of the target in each line, or .npy")
      ->required();
  command.add_option("-n,--number", args->number, "the first so many pairs; 0: all")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  add_word_option(command, "--kind", args->judge.kind,
                  {{"map", TruthKind::map}, {"sym", TruthKind::symmetry}},
                  "map, or sym: the left-right symmetry of each shape");
  add_word_option(command, "--geodesic", args->judge.geodesic,
                  {{"exact", GeodesicKind::exact}, {"graph", GeodesicKind::graph}},
                  "what errors are measured by");
  command
      .add_option("--samples", args->judge.samples,
                  "judge so many rows of the truth, chosen once and for all; 0: all")
      ->check(CLI::Range(0, 1000000000))
      ->capture_default_str();
  command.add_option("--maps", args->judge.maps,
                     "judge SOURCE_TARGET.txt (sym: MESH.txt) of this folder instead of computing");
  command.add_option("--save-maps", args->judge.save,
                     "keep the computed maps in this folder, named as --maps wants them");
  command.add_option("--truth", args->judge.truth,
                     "of one map: a vertex of TARGET for each of SOURCE, from 0, -1 = none");
  add_word_option(command, "--method", args->judge.method,
                  {{"tensor", MatchMethod::tensor}, {"functional", MatchMethod::functional}},
                  "tensor: that of timbre match; functional: descriptors and ZoomOut, which do\n"
                  "not tell left from right (Ovsjanikov et al. 2012), to compare with");
  command.add_option("-k,--count", args->judge.count, "eigenfunctions used")
      ->capture_default_str()
      ->check(CLI::Range(30, 1000));
  add_read_options(command, context);
  add_threads_option(command, context);
  add_common_options(command, context, true);
  command.get_option("--output")
      ->description("log of a set, a line for each pair; an interrupted run goes on from it");
  command.footer(
      "Error: mean geodesic distance on the target to the right vertex, over the square root of\n"
      "the target's area, times 100. Found: a mean below 5, every row of the truth answered (nine\n"
      "tenths for parts).\n"
      "Example:\n  timbre eval match creatures/remeshed -n 20 -o creatures.jsonl");
  command.callback([args, &context] { run(*args, context); });
}

}  // namespace timbre::cli
