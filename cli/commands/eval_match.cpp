#include <algorithm>
#include <cmath>
#include <filesystem>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"
#include "timbre/analysis/core/stopwatch.h"
#include "timbre/cli/command.h"
#include "timbre/cli/commands/eval.h"
#include "timbre/cli/commands/result_log.h"
#include "timbre/cli/version.h"
#include "timbre/datasets/map_scores.h"
#include "timbre/matching/match.h"
#include "timbre/matching/symmetry.h"

namespace timbre::cli {
namespace {

namespace fs = std::filesystem;

enum class TruthKind : std::uint8_t { map, symmetry };

struct Arguments {
  std::vector<std::string> inputs;
  std::string maps, truth;
  TruthKind kind = TruthKind::map;
  GeodesicKind geodesic = GeodesicKind::exact;
  int number = 0;
  int count = 200;
};

constexpr double kCurveStep = 0.5;
constexpr int kCurvePoints = 51;  // errors 0, 0.5, ..., 25

// Truth and errors of one map, and how it was made.
struct Judged {
  std::string source, target;
  MapScore score;
  nlohmann::json made = nlohmann::json::object();
};

nlohmann::json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

nlohmann::json to_json(const Judged& judged) {
  const MapScore& score = judged.score;
  nlohmann::json curve = nlohmann::json::array();
  for (int i = 0; i < kCurvePoints; ++i) curve.push_back(score.share_below(kCurveStep * i));
  nlohmann::json line = judged.made;
  line.update({{"source", judged.source},
               {"target", judged.target},
               {"error", number_or_null(score.mean_error)},
               {"below5", score.below5},
               {"matched", score.matched},
               {"found", score.found},
               {"rows", score.rows},
               {"right", score.share_below(kSymmetryError)},
               {"pck", curve}});
  return line;
}

// A set as a folder of one pair: what lies beside the two files.
ShapeSet set_beside(const std::string& source, const std::string& target) {
  ShapeSet set;
  const fs::path folder = fs::path(source).parent_path();
  set.folder = set.truth_folder = folder.empty() ? "." : folder.string();
  try {
    set = read_shape_set(set.folder);
  } catch (const Error&) {
    // A folder that is no set still holds these two, and what lies beside them.
  }
  const auto add = [&](const std::string& file) {
    const std::string name = fs::path(file).filename().string();
    const bool known = std::any_of(set.shapes.begin(), set.shapes.end(),
                                   [&](const SetShape& one) { return one.name == name; });
    if (!known) set.shapes.push_back({file, name, ""});
  };
  add(source);
  add(target);
  return set;
}

class Judge {
 public:
  Judge(const Arguments& args, const Context& context) : args_(args), context_(context) {}

  Judged one_pair() const {
    const bool symmetric = args_.kind == TruthKind::symmetry;
    const std::string& source = args_.inputs.front();
    const std::string& target = symmetric ? source : args_.inputs[1];
    const ShapeSet set = set_beside(source, target);
    const TriangleMesh A = load(source);
    const TriangleMesh B = symmetric ? A : load(target);
    const Truth truth =
        args_.truth.empty()
            ? truth_of(set, {source, fs::path(source).filename().string(), label(set, source)}, A,
                       {target, fs::path(target).filename().string(), label(set, target)}, B)
            : listed_truth(A, B);
    Judged judged;
    judged.source = fs::path(source).filename().string();
    judged.target = fs::path(target).filename().string();
    judged.score = score(args_.inputs.back(), A, B, truth);
    return judged;
  }

  Judged pair_of(const ShapeSet& set, const std::string& source, const std::string& target) {
    const SetShape& a = find_shape(set, source);
    const SetShape& b = find_shape(set, target);
    const TriangleMesh A = load(a.file);
    const TriangleMesh B = load(b.file);
    const Truth truth = truth_of(set, a, A, b, B);
    Judged judged;
    judged.source = source;
    judged.target = target;
    if (!args_.maps.empty()) {
      judged.score = score(map_file(source, target), A, B, truth);
      return judged;
    }
    Stopwatch watch;
    const std::vector<std::int32_t> map = computed(a, A, b, B, judged.made);
    judged.made["seconds"] = watch.lap();
    judged.score =
        for_file(b.file, [&] { return score_map(map, truth, scale_of(B), context_.threads); });
    return judged;
  }

 private:
  [[nodiscard]] TriangleMesh load(const std::string& file) const {
    return read_set_mesh(file, context_.read).mesh;
  }

  static std::string label(const ShapeSet& set, const std::string& file) {
    return find_shape(set, fs::path(file).filename().string()).label;
  }

  [[nodiscard]] Truth truth_of(const ShapeSet& set, const SetShape& a, const TriangleMesh& A,
                               const SetShape& b, const TriangleMesh& B) const {
    if (args_.kind == TruthKind::symmetry) return symmetry_truth(set, a, A.vertices.rows());
    return map_truth(set, a, A.vertices.rows(), b, B.vertices.rows());
  }

  // A vertex of the target for each of the source.
  [[nodiscard]] Truth listed_truth(const TriangleMesh& A, const TriangleMesh& B) const {
    const std::vector<std::int32_t> image = read_vertex_list(args_.truth, 0, B.vertices.rows());
    require_length(args_.truth, image, A);
    Truth truth;
    for (std::size_t v = 0; v < image.size(); ++v) {
      if (image[v] < 0) continue;
      truth.source.push_back(static_cast<std::int32_t>(v));
      truth.target.push_back(image[v]);
    }
    return truth;
  }

  static void require_length(const std::string& file, const std::vector<std::int32_t>& list,
                             const TriangleMesh& A) {
    if (static_cast<Eigen::Index>(list.size()) == A.vertices.rows()) return;
    throw Error(ErrorKind::bad_input, file, "",
                "has " + std::to_string(list.size()) + " lines; the source has " +
                    std::to_string(A.vertices.rows()) + " vertices");
  }

  [[nodiscard]] ErrorScale scale_of(const TriangleMesh& mesh) const {
    return {mesh, args_.geodesic};
  }

  [[nodiscard]] MapScore score(const std::string& file, const TriangleMesh& A,
                               const TriangleMesh& B, const Truth& truth) const {
    const std::vector<std::int32_t> map = read_vertex_list(file, 0, B.vertices.rows());
    require_length(file, map, A);
    return score_map(map, truth, scale_of(B), context_.threads);
  }

  [[nodiscard]] std::string map_file(const std::string& source, const std::string& target) const {
    const auto stem = [](const std::string& name) { return name.substr(0, name.find_last_of('.')); };
    const std::string name =
        args_.kind == TruthKind::symmetry ? stem(source) : stem(source) + "_" + stem(target);
    return (fs::path(args_.maps) / (name + ".txt")).string();
  }

  // Spectra are the costly part of a pair; those of the last few shapes are kept.
  const MatchSurface& surface(const SetShape& shape, const TriangleMesh& mesh) {
    constexpr std::size_t kKept = 16;
    for (const auto& [name, kept] : surfaces_) {
      if (name == shape.name) return kept;
    }
    if (surfaces_.size() == kKept) surfaces_.pop_front();
    MatchSurface made = for_file(shape.file, [&] {
      return prepare_surface(mesh, {.eigenpairs = args_.count,
                                    .threads = context_.threads,
                                    .progress = context_.progress()});
    });
    surfaces_.emplace_back(shape.name, std::move(made));
    return surfaces_.back().second;
  }

  std::vector<std::int32_t> computed(const SetShape& a, const TriangleMesh& A, const SetShape& b,
                                     const TriangleMesh& B, nlohmann::json& made) {
    const MatchSurface& from = surface(a, A);
    if (args_.kind == TruthKind::symmetry) {
      const std::vector<Reflection> found =
          find_reflections(from, {.threads = context_.threads, .progress = context_.progress()});
      made["confidence"] = found.empty() ? nlohmann::json() : nlohmann::json(found[0].confidence);
      if (!found.empty()) return found[0].map;
      return std::vector<std::int32_t>(static_cast<std::size_t>(A.vertices.rows()), -1);
    }
    const MatchSurface& to = surface(b, B);
    MatchResult result =
        match(from, to, {.threads = context_.threads, .progress = context_.progress()});
    made["verdict"] = to_word(result.verdict);
    return std::move(result.ab);
  }

  const Arguments& args_;
  const Context& context_;
  std::list<std::pair<std::string, MatchSurface>> surfaces_;
};

std::vector<std::pair<std::string, std::string>> work_of(const Arguments& args,
                                                         const ShapeSet& set) {
  std::vector<std::pair<std::string, std::string>> work = set.pairs;
  if (args.kind == TruthKind::symmetry) {
    work.clear();
    for (const SetShape& shape : set.shapes) {
      if (has_symmetry_truth(set, shape)) work.emplace_back(shape.name, shape.name);
    }
  }
  if (args.number > 0) work.resize(std::min(work.size(), static_cast<std::size_t>(args.number)));
  if (work.empty()) {
    throw Error(ErrorKind::bad_input, set.folder, "",
                args.kind == TruthKind::map ? "holds no pair" : "holds no shape of known symmetry");
  }
  return work;
}

std::string row(const nlohmann::json& pair) {
  const std::string verdict = pair.value("verdict", "");
  const auto text = [](const nlohmann::json& value, double factor, int digits) {
    return value.is_null() ? std::string("-") : to_text(factor * value.get<double>(), digits);
  };
  return pair["source"].get<std::string>() + " -> " + pair["target"].get<std::string>() + ": error " +
         text(pair["error"], 1.0, 2) + ", " + text(pair["below5"], 100.0, 1) + " % within 5, " +
         text(pair["matched"], 100.0, 0) + " % answered" +
         (pair["found"].get<bool>() ? "" : ", not found") +
         (verdict.empty() ? "" : ", " + verdict);
}

// Means over pairs, each of the same weight.
nlohmann::json summary(const std::vector<nlohmann::json>& pairs, TruthKind kind) {
  const auto n = static_cast<double>(pairs.size());
  double error = 0.0, found_error = 0.0, matched = 0.0, found = 0.0, answered = 0.0, right = 0.0;
  double meshes = 0.0;
  std::vector<double> curve(kCurvePoints, 0.0);
  std::vector<double> thresholds;
  for (int i = 0; i < kCurvePoints; ++i) thresholds.push_back(kCurveStep * i);
  std::map<std::string, std::array<int, 2>> verdicts;
  for (const nlohmann::json& pair : pairs) {
    const bool is_found = pair["found"].get<bool>();
    if (!pair["error"].is_null()) {
      ++answered;
      error += pair["error"].get<double>();
      if (is_found) found_error += pair["error"].get<double>();
    }
    found += is_found ? 1.0 : 0.0;
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

nlohmann::json parameters(const Arguments& args) {
  return {{"set", args.inputs.front()},
          {"kind", args.kind == TruthKind::map ? "map" : "sym"},
          {"geodesic", args.geodesic == GeodesicKind::exact ? "exact" : "graph"},
          {"maps", args.maps.empty() ? nlohmann::json() : nlohmann::json(args.maps)},
          {"count", args.count},
          {"version", version_text()}};
}

std::vector<nlohmann::json> judge_set(const Arguments& args, const Context& context) {
  const ShapeSet set = read_shape_set(args.inputs.front());
  const auto work = work_of(args, set);
  std::optional<ResultLog> log;
  if (!context.output.empty()) {
    log.emplace(context.output, parameters(args), context.force);
    if (log->kept() > 0) {
      context.note(escape_control(context.output) + ": goes on after " +
                   std::to_string(log->kept()) + " results");
    }
  }
  Judge judge(args, context);
  std::vector<nlohmann::json> pairs;
  for (const auto& [source, target] : work) {
    const std::string key = source + " " + target;
    std::optional<nlohmann::json> known = log ? log->find(key) : std::nullopt;
    if (!known) {
      known = to_json(judge.pair_of(set, source, target));
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
  const std::size_t single = args.kind == TruthKind::map ? 3 : 2;
  if (args.inputs.size() != 1 && args.inputs.size() != single) {
    throw Error(ErrorKind::bad_request, "", "inputs",
                args.kind == TruthKind::map ? "give SET, or SOURCE TARGET MAP"
                                            : "give SET, or MESH MAP");
  }
  if (is_set(args) && !args.truth.empty()) {
    throw Error(ErrorKind::bad_request, "", "truth", "is of one map; a set has its own");
  }
  if (!is_set(args) && (!args.maps.empty() || !context.output.empty() || args.number > 0)) {
    throw Error(ErrorKind::bad_request, "", "inputs", "--maps, -n and -o are for sets");
  }
}

void run(const Arguments& args, Context& context) {
  require_sense(args, context);
  std::vector<nlohmann::json> pairs;
  if (is_set(args)) {
    pairs = judge_set(args, context);
  } else {
    pairs.push_back(to_json(Judge(args, context).one_pair()));
  }
  nlohmann::json document = summary(pairs, args.kind);
  document["geodesic"] = parameters(args)["geodesic"];
  context.answer(document, (is_set(args) ? "" : escape_control(row(pairs[0])) + "\n") +
                               to_prose(document, pairs.size()));
}

}  // namespace

void add_eval_match(CLI::App& eval, Context& context) {
  auto args = std::make_shared<Arguments>();
  CLI::App& command = *eval.add_subcommand("match", "How right are maps? One, or those of a set");
  command
      .add_option("INPUTS", args->inputs,
                  "a folder of shapes with truth, or SOURCE TARGET MAP (with --kind sym: MESH MAP)")
      ->required();
  command.add_option("-n,--number", args->number, "the first so many pairs; 0: all")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  command.add_option("--kind", args->kind, "map, or sym: the left-right symmetry of each shape")
      ->transform(CLI::CheckedTransformer(std::map<std::string, TruthKind>{
          {"map", TruthKind::map}, {"sym", TruthKind::symmetry}}))
      ->default_str("map");
  command.add_option("--geodesic", args->geodesic, "what errors are measured by: exact or graph")
      ->transform(CLI::CheckedTransformer(std::map<std::string, GeodesicKind>{
          {"exact", GeodesicKind::exact}, {"graph", GeodesicKind::graph}}))
      ->default_str("exact");
  command.add_option("--maps", args->maps,
                     "judge SOURCE_TARGET.txt (sym: MESH.txt) of this folder instead of computing");
  command.add_option("--truth", args->truth,
                     "of one map: a vertex of TARGET for each of SOURCE, from 0, -1 = none");
  command.add_option("-k,--count", args->count, "eigenfunctions used")
      ->capture_default_str()
      ->check(CLI::Range(30, 1000));
  add_read_options(command, context);
  add_threads_option(command, context);
  add_common_options(command, context, true);
  command.get_option("--output")->description(
      "log of a set, a line for each pair; an interrupted run goes on from it");
  command.footer(
      "Error: mean geodesic distance on the target to the right vertex, over the square root of\n"
      "the target's area, times 100. Found: a mean below 5, every row of the truth answered.\n"
      "Example:\n  timbre eval match creatures/remeshed -n 20 -o creatures.jsonl");
  command.callback([args, &context] { run(*args, context); });
}

}  // namespace timbre::cli
