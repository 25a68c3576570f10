#pragma once

#include "timbre/cli/command.h"

namespace timbre::cli {

void add_eval_match(CLI::App& eval, Context& context);
void add_eval_retrieval(CLI::App& eval, Context& context);

}  // namespace timbre::cli
