#include "timbre/cli/commands/eval.h"

namespace timbre::cli {

void add_eval(CLI::App& timbre, Context& context) {
  CLI::App& eval = *timbre.add_subcommand("eval", "Measures what the methods reach");
  eval.require_subcommand(1);
  add_eval_match(eval, context);
  add_eval_retrieval(eval, context);
}

}  // namespace timbre::cli
