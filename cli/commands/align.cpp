#include "timbre/matching/alignment.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "timbre/analysis/core/array_file.h"
#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"
#include "timbre/analysis/core/output_file.h"
#include "timbre/cli/commands/map_input.h"
#include "timbre/cli/commands/map_output.h"
#include "timbre/cli/options.h"
#include "timbre/datasets/shape_set.h"
#include "timbre/index/store.h"
#include "timbre/matching/match.h"

namespace timbre::cli {
namespace {

namespace fs = std::filesystem;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Arguments {
  std::vector<std::string> subjects;
  std::string reference;
  AlignmentOptions alignment;
  int count = 200;  ///< of eigenfunctions that the maps are found with
  bool strict = false;
};

// Where meshes come from: files, or the shapes of a database.
class Cohort {
 public:
  Cohort(const Arguments& args, const Context& context) : args_(args), context_(context) {
    if (args.subjects.size() != 1 || !is_store(args.subjects[0])) return;
    store_.emplace(Store::open(args.subjects[0]));
    if (!store_->find(args.reference)) {
      throw Error(ErrorKind::bad_request, args.subjects[0], "reference",
                  "no shape is named " + args.reference);
    }
  }

  [[nodiscard]] std::vector<std::string> subjects() const {
    if (!store_) return args_.subjects;
    std::vector<std::string> names;
    for (const ShapeInfo& shape : store_->list()) names.push_back(shape.name);
    return names;
  }

  [[nodiscard]] MatchSurface surface(const std::string& subject) const {
    if (!store_) return load_surface(context_, subject, args_.count);
    return prepare_for_matching(context_, subject, store_->mesh(subject), args_.count);
  }

  [[nodiscard]] std::string file_name(const std::string& subject) const {
    if (store_) return subject + ".npz";
    return shape_stem(fs::path(subject).filename().string()) + ".npz";
  }

 private:
  const Arguments& args_;
  const Context& context_;
  std::optional<Store> store_;
};

// The file of each subject in the output folder; the reference is one of them.
std::map<std::string, std::string> output_files(const Cohort& cohort, const Arguments& args,
                                                const Context& context) {
  std::vector<std::string> subjects = cohort.subjects();
  subjects.push_back(args.reference);
  std::map<std::string, std::string> path_of;
  std::map<std::string, std::string> subject_of;
  for (const std::string& subject : subjects) {
    const std::string path = (fs::path(context.output) / cohort.file_name(subject)).string();
    const auto [other, is_new] = subject_of.emplace(path, subject);
    if (!is_new && other->second != subject) {
      throw Error(ErrorKind::bad_request, subject, "output",
                  "would be written to the file of " + other->second);
    }
    path_of[subject] = path;
  }
  std::error_code failure;
  fs::create_directories(context.output, failure);
  if (failure) throw Error(ErrorKind::io, context.output, "", failure.message());
  for (const auto& [path, subject] : subject_of) require_writable(path, context.force);
  return path_of;
}

// Rows of the component at the vertices of the file; 0 elsewhere.
MatrixXd at_file_vertices(const MatchSurface& surface, const MatrixXd& rows) {
  MatrixXd all = MatrixXd::Zero(surface.file_vertices, rows.cols());
  all(surface.vertex, Eigen::all) = rows;
  return all;
}

std::string basis_bytes(const MatchSurface& surface, const AlignedBasis& basis,
                        const PointMap& to_reference) {
  const MatrixXd vectors = surface.vectors * basis.mixture / std::sqrt(surface.area);
  return to_npz({{"evals", to_npy(VectorXd(basis.values / surface.area))},
                 {"evecs", to_npy(at_file_vertices(surface, vectors))},
                 {"mass", to_npy(VectorXd(at_file_vertices(surface, surface.mass * surface.area)))},
                 {"agreement", to_npy(basis.agreement)},
                 {"mixture", to_npy(basis.mixture)},
                 {"p2p", to_npy_bytes(to_reference)}});
}

AlignedBasis own_basis(const MatchSurface& reference, int count) {
  return {reference.values.head(count), MatrixXd::Identity(reference.values.size(), count),
          VectorXd::Ones(count)};
}

PointMap own_map(const MatchSurface& reference) {
  PointMap map(static_cast<std::size_t>(reference.file_vertices), -1);
  for (const std::int32_t v : reference.vertex) map[static_cast<std::size_t>(v)] = v;
  return map;
}

struct Outcome {
  nlohmann::json document;
  std::string line;
  bool is_clear = false;
};

Outcome align_subject(const std::string& subject, const MatchSurface& reference,
                      const MatchSurface& surface, const Arguments& args, const Context& context,
                      const std::string& path) {
  const MatchResult found =
      match(reference, surface, {.threads = context.threads, .progress = context.progress()});
  Outcome outcome;
  outcome.is_clear = found.verdict == Verdict::clear;
  outcome.document = {
      {"mesh", subject}, {"verdict", to_word(found.verdict)}, {"reason", found.reason}};
  outcome.line = "  " + escape_control(subject) + ": " + to_word(found.verdict);
  if (found.verdict == Verdict::failed) {
    outcome.line += " (" + found.reason + "); nothing is written\n";
    return outcome;
  }
  const AlignedBasis basis =
      align_basis(found.solutions[0].functional.ab, surface.values, args.alignment);
  context.write_result(path, basis_bytes(surface, basis, found.ba));
  const int comparable = comparable_functions(basis);
  outcome.document["comparable"] = comparable;
  outcome.document["agreement"] = basis.agreement;
  outcome.document["eigenvalues"] = VectorXd(basis.values / surface.area);
  outcome.document["output"] = path;
  if (!found.reason.empty()) outcome.line += " (" + found.reason + ")";
  outcome.line += ", the first " + std::to_string(comparable) + " of " +
                  std::to_string(args.alignment.count) + " agree, mean agreement " +
                  to_text(basis.agreement.mean(), 2) + "\n";
  return outcome;
}

void run(const Arguments& args, Context& context) {
  if (args.alignment.count > args.count) {
    throw Error(ErrorKind::bad_request, "", "-k",
                "is " + std::to_string(args.alignment.count) + "; maps are found with " +
                    std::to_string(args.count) + " functions (--map-functions)");
  }
  const Cohort cohort(args, context);
  const std::map<std::string, std::string> path_of = output_files(cohort, args, context);
  const MatchSurface reference = cohort.surface(args.reference);
  const auto enough = [&](const std::string& subject, const MatchSurface& surface) {
    if (surface.values.size() >= args.alignment.count) return;
    throw Error(ErrorKind::bad_request, subject, "-k",
                "is " + std::to_string(args.alignment.count) + "; this mesh has only " +
                    std::to_string(surface.values.size()) + " eigenfunctions");
  };
  enough(args.reference, reference);
  context.write_result(
      path_of.at(args.reference),
      basis_bytes(reference, own_basis(reference, args.alignment.count), own_map(reference)));

  nlohmann::json subjects = nlohmann::json::array();
  std::string text = escape_control(args.reference) + ": the reference of\n";
  int doubtful = 0;
  int comparable = args.alignment.count;
  for (const std::string& subject : cohort.subjects()) {
    if (subject == args.reference) continue;
    const MatchSurface surface = cohort.surface(subject);
    enough(subject, surface);
    Outcome outcome =
        align_subject(subject, reference, surface, args, context, path_of.at(subject));
    comparable = std::min(comparable, outcome.document.value("comparable", comparable));
    doubtful += outcome.is_clear ? 0 : 1;
    text += outcome.line;
    subjects.push_back(std::move(outcome.document));
  }
  text += "the first " + std::to_string(comparable) + " functions agree in all that are written\n";
  if (args.strict && doubtful > 0) context.exit_code = 3;
  context.answer({{"reference", args.reference},
                  {"count", args.alignment.count},
                  {"near_equal", args.alignment.near_equal},
                  {"comparable", comparable},
                  {"subjects", subjects}},
                 text);
}

}  // namespace

void add_align(CLI::App& timbre, Context& context) {
  auto args = std::make_shared<Arguments>();
  CLI::App& command = *timbre.add_subcommand(
      "align", "Bring the eigenfunctions of many shapes into agreement with a reference");
  command.add_option("SUBJECTS", args->subjects, "mesh files, or one database")->required();
  command.add_option("--reference", args->reference, "mesh file, or name in the database")
      ->required();
  command.add_option("-k,--count", args->alignment.count, "functions, the constant among them")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  command
      .add_option("--near", args->alignment.near_equal,
                  "functions may be mixed whose eigenvalues differ by this share; 0: none")
      ->capture_default_str()
      ->check(number_between(0.0, 10.0));
  command.add_option("--map-functions", args->count, "eigenfunctions that maps are found with")
      ->capture_default_str()
      ->check(CLI::Range(30, 1000));
  command.add_flag("--strict", args->strict, "exit with 3 unless every map is clear");
  command.add_option("-o,--output", context.output, "folder to make, a file for each shape")
      ->required();
  command.add_flag("--force", context.force, "replace files that are there");
  add_read_options(command, context);
  add_threads_option(command, context);
  add_common_options(command, context, false);
  command.footer(
      "FOLDER/NAME.npz holds evals, evecs and mass at the scale of the file, agreement (1: as in\n"
      "the reference), mixture (of which own eigenfunctions each is made) and p2p (the vertex of\n"
      "the reference for each vertex, -1 for none).\n"
      "Example:\n  timbre align left_*.ply --reference left_001.ply -k 50 -o aligned");
  command.callback([args, &context] { run(*args, context); });
}

}  // namespace timbre::cli
