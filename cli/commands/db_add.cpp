#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/cli/commands/db.h"
#include "timbre/cli/options.h"
#include "timbre/index/ingest.h"
#include "timbre/index/labels.h"

namespace timbre::cli {
namespace {

struct Arguments {
  std::string database;
  std::vector<std::string> files;
  std::string name;
  std::string labels;
  int label_column = 2;
  bool replace = false;
  OperatorOptions op;
  int count = StoreParameters().count;
  double memory = 0.0;  // GiB; 0: by what is free
  // Given on the command line: only these must agree with a database that is there.
  bool operator_given = false, mass_given = false, count_given = false;
};

StoreParameters wanted_parameters(const Arguments& args, StoreParameters parameters) {
  if (args.operator_given && args.op.kind != parameters.operator_kind) {
    parameters.operator_kind = args.op.kind;
    parameters.mass = mass_of({.kind = args.op.kind});
  }
  if (args.mass_given) {
    parameters.mass = mass_of({.kind = parameters.operator_kind, .mass = args.op.mass});
  }
  if (args.count_given) parameters.count = args.count;
  return parameters;
}

Store open_or_create(const Arguments& args) {
  if (!std::filesystem::exists(args.database)) {
    try {
      return Store::create(args.database, wanted_parameters(args, {}));
    } catch (const Error&) {
      // Another process may have made it since.
      if (!std::filesystem::exists(args.database)) throw;
    }
  }
  Store store = Store::open(args.database, StoreAccess::write);
  const StoreParameters wanted = wanted_parameters(args, store.parameters());
  if (wanted != store.parameters()) {
    throw Error(ErrorKind::bad_request, args.database, "parameters",
                "the database holds " + canonical_text(to_parameters(store.parameters())) +
                    ", asked for " + canonical_text(to_parameters(wanted)) +
                    "; create a new database for these");
  }
  return store;
}

std::vector<IngestInput> inputs_of(const Arguments& args) {
  if (!args.name.empty() && args.files.size() != 1) {
    throw Error(ErrorKind::bad_request, "", "--name",
                "goes with one file; " + std::to_string(args.files.size()) + " are given");
  }
  const Labels labels = args.labels.empty() ? Labels() : Labels(args.labels, args.label_column);
  std::vector<IngestInput> inputs;
  for (const std::string& file : args.files) {
    inputs.push_back({file, args.name, labels.of(file == "-" ? args.name : file)});
  }
  return inputs;
}

const char* word(AddOutcome outcome) {
  switch (outcome) {
    case AddOutcome::added:
      return "added";
    case AddOutcome::kept:
      return "kept";
    case AddOutcome::replaced:
      break;
  }
  return "replaced";
}

void report(const Context& context, const IngestResult& result, nlohmann::json& results) {
  for (const ReadWarning& warning : result.warnings) {
    context.note(result.path + ": " + warning.message);
  }
  const std::string outcome = result.outcome ? word(*result.outcome) : "failed";
  if (result.outcome) {
    context.say(outcome + " " + result.name);
  } else {
    context.complain(result.error);
  }
  if (!context.json) return;
  results.push_back({{"file", result.path}, {"name", result.name}, {"outcome", outcome}});
  if (!result.outcome) results.back()["error"] = result.error;
}

void run(const Arguments& args, Context& context) {
  const std::vector<IngestInput> inputs = inputs_of(args);
  Store store = open_or_create(args);
  nlohmann::json results = nlohmann::json::array();
  const IngestSummary summary =
      add_files(store, inputs,
                {.replace = args.replace,
                 .threads = context.threads,
                 .memory = static_cast<std::int64_t>(args.memory * 0x1p30),
                 .progress = context.progress(),
                 .read = context.read},
                [&](const IngestResult& result) { report(context, result, results); });
  if (summary.failed > 0) context.exit_code = 1;
  if (!context.json) return;
  context.answer({{"added", summary.added},
                  {"kept", summary.kept},
                  {"replaced", summary.replaced},
                  {"failed", summary.failed},
                  {"results", results}},
                 "");
}

}  // namespace

void add_db_add(CLI::App& db, Context& context) {
  auto args = std::make_shared<Arguments>();
  CLI::App& command = *db.add_subcommand("add", "Solves meshes and stores them");
  command.add_option("DB", args->database, "the database; made if it is not there")->required();
  command.add_option("FILES", args->files, "mesh files, or - for standard input")->required();
  command.add_option("--name", args->name, "name of the one shape; default: its file's");
  command.add_option("--labels", args->labels, "text file of FILE LABEL ... lines");
  command.add_option("--label-column", args->label_column, "column of the label; FILE is 1")
      ->capture_default_str()
      ->check(CLI::Range(2, 1000));
  command.add_flag("--replace", args->replace, "put other content in place of what is there");
  add_operator_options(command, args->op);
  command.add_option("-k,--count", args->count, "eigenvalues kept of each shape")
      ->capture_default_str()
      ->check(CLI::Range(2, 100000));
  add_read_options(command, context);
  add_threads_option(command, context);
  command
      .add_option("--memory", args->memory,
                  "GiB for meshes solved at a time; default: three quarters of what is free")
      ->check(number_between(0.001, 1e6));
  add_common_options(command, context, false);
  command.footer(
      "A line 'added NAME' means that NAME is on disk, whatever happens next. Adding again\n"
      "goes on where an interrupted run stopped.\n"
      "Example:\n  timbre db add shapes.timbre scans/*.ply --labels classes.txt");
  command.callback([args, &command, &context] {
    args->operator_given = command.count("--operator") > 0;
    args->mass_given = command.count("--mass") > 0;
    args->count_given = command.count("--count") > 0;
    run(*args, context);
  });
}

}  // namespace timbre::cli
