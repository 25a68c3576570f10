#include "timbre/cli/commands/filter.h"

#include <memory>

#include "timbre/analysis/core/error.h"
#include "timbre/cli/options.h"

namespace timbre::cli {
namespace {

constexpr int kMostEigenpairs = 1000000;

CLI::Option* add_ends(CLI::App& group, const std::string& name, std::vector<int>& ends,
                      const std::string& about) {
  return group.add_option(name, ends, about)
      ->delimiter(',')
      ->expected(2)
      ->type_name("FIRST,LAST")
      ->check(CLI::Range(0, kMostEigenpairs));
}

void require_ascending(const std::string& option, const std::vector<int>& ends) {
  if (ends.empty() || ends[0] <= ends[1]) return;
  throw Error(
      ErrorKind::bad_request, "", option,
      "ends before it begins: " + std::to_string(ends[0]) + " to " + std::to_string(ends[1]));
}

// What is asked for: exactly one of the group. The others go with some of these only.
void add_tasks(CLI::App& command, FilterArguments& args) {
  CLI::App& task = *command.add_option_group("task")->require_option(1);
  CLI::Option* const low_pass =
      task.add_option("--low-pass", args.low_pass, "keep the lowest K eigenfunctions")
          ->type_name("K")
          ->check(CLI::Range(1, kMostEigenpairs));
  CLI::Option* const band =
      add_ends(task, "--band", args.band, "keep these eigenfunctions only, from 0");
  CLI::Option* const stop = add_ends(task, "--stop", args.stop, "take these out, keep all else");
  task.add_option("--smooth", args.smooth,
                  "heat flow for so long, at unit total area: factor e^(-lambda T)")
      ->type_name("T")
      ->check(number_between(0.0, 1e300));
  task.add_option("--transfer", args.transfer,
                  "a table of 'lambda factor', lambda at unit total area; straight lines between, "
                  "level beyond")
      ->type_name("FILE");
  CLI::Option* const coefficients =
      task.add_flag("--coefficients", args.coefficients, "the transform itself, k x columns");
  CLI::Option* const fiedler =
      task.add_flag("--fiedler", args.fiedler, "vertices in the order of the Fiedler vector");
  CLI::Option* const nodal =
      task.add_option("--nodal", args.nodal, "label the nodal domains of eigenfunction I, from 0")
          ->type_name("I")
          ->check(CLI::Range(0, kMostEigenpairs));

  command
      .add_option("--function", args.function,
                  "work on the columns of this table (.npy or text, a row per vertex), not on the "
                  "coordinates")
      ->excludes(fiedler, nodal);
  command
      .add_option("-k,--count", args.count,
                  "eigenfunctions for --smooth, --transfer and --coefficients")
      ->capture_default_str()
      ->check(CLI::Range(1, kMostEigenpairs))
      ->excludes(low_pass, band, stop, fiedler, nodal);
  add_word_option(
      command, "--detail", args.detail,
      {{"last", Detail::last}, {"keep", Detail::keep}, {"drop", Detail::drop}},
      "with --smooth and --transfer, what lies beyond the k eigenfunctions: times the last one's "
      "factor, kept as it is, or dropped")
      ->excludes(low_pass, band, stop, coefficients, fiedler, nodal);
}

void run(const FilterArguments& args, const Context& context) {
  require_ascending("--band", args.band);
  require_ascending("--stop", args.stop);
  if (args.fiedler) {
    run_fiedler_order(args, context);
  } else if (args.nodal) {
    run_nodal_domains(args, context);
  } else {
    run_filter(args, context);
  }
}

}  // namespace

void add_filter(CLI::App& timbre, Context& context) {
  auto args = std::make_shared<FilterArguments>();
  CLI::App& command = *timbre.add_subcommand(
      "filter", "Coordinates or functions filtered by their spectrum; vertex orders and regions");
  command.add_option("MESH", args->mesh, "mesh file, or - for standard input")->required();
  add_tasks(command, *args);
  add_operator_options(command, args->op);
  add_boundary_option(command, args->op);
  add_read_options(command, context);
  add_threads_option(command, context);
  add_common_options(command, context, true);
  command.footer(
      "Filtered coordinates go to a mesh file, -o F.ply (.off, .obj, .stl, .vtk, .glb; - is PLY);\n"
      "all else to F.npy, F.npz, F.mat or F.txt.\n"
      "Example:\n  timbre filter horse.ply --low-pass 60 -o horse_60.ply");
  command.callback([args, &context] { run(*args, context); });
}

}  // namespace timbre::cli
