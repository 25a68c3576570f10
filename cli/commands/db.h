#pragma once

#include "timbre/cli/command.h"

namespace timbre::cli {

// The subcommands of `timbre db`, one file each where they are more than a few lines.
void add_db_add(CLI::App& db, Context& context);
void add_db_export(CLI::App& db, Context& context);

}  // namespace timbre::cli
