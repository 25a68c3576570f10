#include "timbre/cli/command.h"

namespace timbre::cli {

void add_eval_retrieval(CLI::App& eval, Context& context);

void add_eval(CLI::App& timbre, Context& context) {
  CLI::App& eval = *timbre.add_subcommand("eval", "Measures what the methods reach");
  eval.require_subcommand(1);
  add_eval_retrieval(eval, context);
}

}  // namespace timbre::cli
