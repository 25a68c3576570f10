#include "timbre/cli/report/report.h"

#include <memory>
#include <string>

#include "timbre/analysis/core/error.h"
#include "timbre/cli/command.h"
#include "timbre/cli/options.h"

namespace timbre::cli {
namespace {

// Its own copy of the inputs: what progress has left on the terminal goes away with it, before
// the answer comes.
ReportPage make(ReportInputs inputs, const Context& context) {
  inputs.pictures.threads = context.threads;
  inputs.pictures.progress = context.progress();
  return make_report(inputs);
}

void run(const ReportInputs& inputs, const Context& context) {
  context.require_output();
  const ReportPage made = make(inputs, context);
  context.write_result(context.output, made.html);
  context.answer(
      {{"output", context.output}, {"sections", made.sections}, {"bytes", made.html.size()}},
      context.output == "-" ? "" : "wrote " + escape_control(context.output) + "\n");
}

}  // namespace

void add_report(CLI::App& timbre, Context& context) {
  auto inputs = std::make_shared<ReportInputs>();
  CLI::App& command =
      *timbre.add_subcommand("report", "A page that shows a database and how well things work");
  command.add_option("DB", inputs->database, "the database")->required();
  command.add_option("--title", inputs->title, "heading of the page");
  command.add_option("--set", inputs->set,
                     "folder of shapes with truth that the logs are about; default: DB's meshes, "
                     "and no pictures of errors");
  CLI::Option* const matches =
      command.add_option("--matches", inputs->matches, "log of 'timbre eval match SET -o FILE'");
  command.add_option("--maps", inputs->maps, "folder of its maps, from --save-maps")
      ->needs(matches);
  CLI::Option* const symmetries = command.add_option(
      "--symmetries", inputs->symmetries, "log of 'timbre eval match SET --kind sym -o FILE'");
  command.add_option("--symmetry-maps", inputs->symmetry_maps, "folder of its maps")
      ->needs(symmetries);
  add_up_option(command, inputs->pictures.up);
  add_threads_option(command, context);
  add_common_options(command, context, true);
  command.get_option("--output")->required()->description("the page; - for standard output");
  command.footer(
      "The page is one file that needs no other and no network. What is not given is left out.\n"
      "Example:\n  timbre report shapes.timbre -o report.html");
  command.callback([inputs, &context] { run(*inputs, context); });
}

}  // namespace timbre::cli
