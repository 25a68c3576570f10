#include "timbre/matching/alignment.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <system_error>
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
  int map_functions = 200;
  bool strict = false;
};

struct Subject {
  std::string name;    ///< path, or name in the database
  std::string output;  ///< path of its file
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

  /// The reference first, then all others, each once.
  [[nodiscard]] std::vector<Subject> subjects() const {
    std::vector<std::string> names = {args_.reference};
    for (const std::string& name : listed()) {
      const bool is_new = std::none_of(names.begin(), names.end(),
                                       [&](const std::string& other) { return same(name, other); });
      if (is_new) names.push_back(name);
    }
    return with_outputs(names);
  }

  [[nodiscard]] MatchSurface surface(const std::string& name) const {
    if (!store_) return load_surface(context_, name, args_.map_functions);
    return prepare_for_matching(context_, name, store_->mesh(name), args_.map_functions);
  }

 private:
  [[nodiscard]] std::vector<std::string> listed() const {
    if (!store_) return args_.subjects;
    std::vector<std::string> names;
    for (const ShapeInfo& shape : store_->list()) names.push_back(shape.name);
    return names;
  }

  [[nodiscard]] bool same(const std::string& name, const std::string& other) const {
    if (name == other) return true;
    std::error_code failure;
    return !store_ && fs::equivalent(name, other, failure) && !failure;
  }

  // As short as tells them apart: the stem, the file's name, and that after its folders'.
  [[nodiscard]] std::vector<Subject> with_outputs(const std::vector<std::string>& names) const {
    constexpr int kMostFolders = 4;
    for (int parts = 0; parts <= kMostFolders; ++parts) {
      std::vector<Subject> subjects;
      std::set<std::string> outputs;
      for (const std::string& name : names) {
        const fs::path output = fs::path(context_.output) / (short_name(name, parts) + ".npz");
        subjects.push_back({name, output.string()});
        outputs.insert(output.string());
      }
      if (outputs.size() == names.size()) return subjects;
    }
    throw Error(ErrorKind::bad_request, "", "SUBJECTS",
                "have the same names in folders of the same names");
  }

  [[nodiscard]] std::string short_name(const std::string& name, int parts) const {
    std::string text = name;
    if (!store_) {
      const fs::path path(name);
      text = path.filename().string();
      if (parts == 0) return shape_stem(text);
      fs::path folder = fs::absolute(path).lexically_normal().parent_path();
      for (int i = 1; i < parts; ++i, folder = folder.parent_path()) {
        text.insert(0, folder.filename().string() + "_");
      }
    }
    std::replace(text.begin(), text.end(), '/', '_');
    return text;
  }

  const Arguments& args_;
  const Context& context_;
  std::optional<Store> store_;
};

void require_outputs(const std::vector<Subject>& subjects, const Context& context) {
  if (context.output.empty()) {
    throw Error(ErrorKind::bad_request, "", "output", "a folder is needed");
  }
  for (const Subject& subject : subjects) {
    std::error_code failure;
    if (context.force || !fs::exists(subject.output, failure)) continue;
    throw Error(ErrorKind::bad_request, subject.output, "output",
                "exists already; --force replaces it");
  }
}

// Empty of what will be written: bases of two references must not stand side by side.
void make_folder(const std::vector<Subject>& subjects, const Context& context) {
  std::error_code failure;
  fs::create_directories(context.output, failure);
  if (failure) throw Error(ErrorKind::io, context.output, "", failure.message());
  for (const Subject& subject : subjects) require_writable(subject.output, context.force);
  for (const Subject& subject : subjects) {
    fs::remove(subject.output, failure);
    if (failure) throw Error(ErrorKind::io, subject.output, "", failure.message());
  }
}

// Rows of the component at the vertices of the file; 0 elsewhere.
MatrixXd at_file_vertices(const MatchSurface& surface, const MatrixXd& rows) {
  MatrixXd all = MatrixXd::Zero(surface.file_vertices, rows.cols());
  all(surface.vertex, Eigen::all) = rows;
  return all;
}

std::string basis_bytes(const MatchSurface& surface, const AlignedBasis& basis,
                        const PointMap& to_reference) {
  const MatrixXd vectors =
      surface.vectors.leftCols(basis.mixture.rows()) * basis.mixture / std::sqrt(surface.area);
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

void require_enough(const MatchSurface& surface, int count) {
  if (surface.values.size() >= count) return;
  throw Error(ErrorKind::bad_request, "", "-k",
              "is " + std::to_string(count) + "; this mesh has only " +
                  std::to_string(surface.values.size()) + " eigenfunctions");
}

class Aligner {
 public:
  Aligner(const Arguments& args, const Context& context) : args_(args), context_(context) {}

  void run() {
    const Cohort cohort(args_, context_);
    const std::vector<Subject> subjects = cohort.subjects();
    require_outputs(subjects, context_);
    const MatchSurface reference = cohort.surface(args_.reference);
    const int count = args_.alignment.count;
    for_file(args_.reference, [&] { require_enough(reference, count); });
    make_folder(subjects, context_);
    context_.write_result(subjects[0].output,
                          basis_bytes(reference, own_basis(reference, count), own_map(reference)));
    context_.say(escape_control(args_.reference) + ": the reference");
    for (std::size_t i = 1; i < subjects.size(); ++i) {
      align_or_complain(subjects[i], reference, cohort);
    }
  }

  [[nodiscard]] nlohmann::json document() const {
    return {{"reference", args_.reference},
            {"count", args_.alignment.count},
            {"near_equal", args_.alignment.near_equal},
            {"comparable", written_ > 0 ? nlohmann::json(comparable_) : nlohmann::json()},
            {"failed", failed_},
            {"subjects", subjects_}};
  }

  [[nodiscard]] std::string summary() const {
    if (written_ == 0) return "no shape was brought into agreement\n";
    return "the first " + std::to_string(comparable_) + " of " +
           std::to_string(args_.alignment.count) + " functions agree in all that are written\n";
  }

  [[nodiscard]] int exit_code() const {
    if (failed_ > 0) return 1;
    return args_.strict && doubtful_ > 0 ? 3 : 0;
  }

 private:
  // One bad shape does not end the work on the others.
  void align_or_complain(const Subject& subject, const MatchSurface& reference,
                         const Cohort& cohort) {
    try {
      align(subject, reference, for_file(subject.name, [&] {
              MatchSurface surface = cohort.surface(subject.name);
              require_enough(surface, args_.alignment.count);
              return surface;
            }));
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::cancelled) throw;
      context_.complain(error.what());
      subjects_.push_back({{"mesh", subject.name}, {"error", error.what()}});
      ++failed_;
    }
  }

  void align(const Subject& subject, const MatchSurface& reference, const MatchSurface& surface) {
    const MatchResult found =
        match(reference, surface, {.threads = context_.threads, .progress = context_.progress()});
    nlohmann::json document = {
        {"mesh", subject.name}, {"verdict", to_word(found.verdict)}, {"reason", found.reason}};
    std::string line = escape_control(subject.name) + ": " + to_word(found.verdict);
    if (!found.reason.empty()) line += " (" + found.reason + ")";
    if (found.verdict != Verdict::clear) ++doubtful_;
    if (found.verdict == Verdict::failed) {
      line += ": nothing is written";
    } else {
      const MatchSolution& best = found.solutions[0];
      const MatrixXd& C = best.functional.ab;
      const AlignedBasis basis = align_basis(C, surface.values.head(C.cols()), args_.alignment);
      context_.write_result(subject.output, basis_bytes(surface, basis, found.ba));
      ++written_;
      const int comparable = comparable_functions(basis);
      comparable_ = std::min(comparable_, comparable);
      document["orientation"] = to_word(best.orientation);
      document["comparable"] = comparable;
      document["agreement"] = basis.agreement;
      document["eigenvalues"] = VectorXd(basis.values / surface.area);
      document["output"] = subject.output;
      if (best.orientation == MapOrientation::mirrored) line += ", as a mirror image";
      line += ", the first " + std::to_string(comparable) + " of " +
              std::to_string(args_.alignment.count) + " agree, mean agreement " +
              to_text(basis.agreement.mean(), 2);
    }
    context_.say(line);
    subjects_.push_back(std::move(document));
  }

  const Arguments& args_;
  const Context& context_;
  nlohmann::json subjects_ = nlohmann::json::array();
  int comparable_ = args_.alignment.count;
  int written_ = 0;
  int doubtful_ = 0;
  int failed_ = 0;
};

void run(const Arguments& args, Context& context) {
  if (args.alignment.count > args.map_functions) {
    throw Error(ErrorKind::bad_request, "", "-k",
                "is " + std::to_string(args.alignment.count) + "; maps are found with " +
                    std::to_string(args.map_functions) + " functions (--map-functions)");
  }
  Aligner aligner(args, context);
  aligner.run();
  context.exit_code = aligner.exit_code();
  context.answer(aligner.document(), aligner.summary());
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
      ->check(CLI::Range(1, 200));
  command
      .add_option("--near", args->alignment.near_equal,
                  "functions may be mixed whose eigenvalues differ by this share; 0: none")
      ->capture_default_str()
      ->check(number_between(0.0, 0.5));
  command
      .add_option("--map-functions", args->map_functions, "eigenfunctions that maps are found with")
      ->capture_default_str()
      ->check(CLI::Range(30, 200));
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
      "the reference for each vertex, -1 for none). A shape that cannot be read ends in a line on\n"
      "standard error, and the command in 1, when all others are done.\n"
      "Example:\n  timbre align left_*.ply --reference left_001.ply -k 50 -o aligned");
  command.callback([args, &context] { run(*args, context); });
}

}  // namespace timbre::cli
