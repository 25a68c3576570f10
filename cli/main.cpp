#include <unistd.h>

#include <algorithm>
#include <new>
#include <numeric>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/cli/command.h"
#include "timbre/cli/version.h"

namespace {

using timbre::Error;
using timbre::ErrorKind;

int exit_code(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::bad_request:
      return 2;
    case ErrorKind::cancelled:
      return 130;
    default:
      return 1;
  }
}

// Not iostreams: one write, so that the line stays one line among other processes' lines.
int complain(const std::string& line, int code) {
  const std::string whole = "timbre: " + line + "\n";
  [[maybe_unused]] const ssize_t ignored = ::write(STDERR_FILENO, whole.data(), whole.size());
  return code;
}

void add_commands(CLI::App& app, timbre::cli::Context& context) {
  using namespace timbre::cli;  // NOLINT(google-build-using-namespace): the names of one room
  add_info(app, context);
  add_spectrum(app, context);
  add_signature(app, context);
  add_embed(app, context);
  add_distance(app, context);
  add_filter(app, context);
  add_db(app, context);
  add_query(app, context);
  add_match(app, context);
  add_symmetry(app, context);
  add_align(app, context);
  add_eval(app, context);
  add_dataset(app, context);
  add_render(app, context);
  add_report(app, context);
}

// Edits (insert, delete, replace, one each) from one word to another.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0U);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = diagonal + (a[i - 1] == b[j - 1] ? 0U : 1U);
      diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, replace}));
    }
  }
  return row.back();
}

// A first word that is no command gets the nearest one's name.
void check_command_name(const CLI::App& app, int argc, char** argv) {
  const std::string word = argc > 1 ? argv[1] : "";
  if (word.empty() || word[0] == '-') return;
  std::string nearest;
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->get_name() == word) return;
    if (nearest.empty() ||
        edit_distance(word, command->get_name()) < edit_distance(word, nearest)) {
      nearest = command->get_name();
    }
  }
  throw Error(ErrorKind::bad_request, "", word,
              "is no command; did you mean '" + nearest + "'? see timbre --help");
}

int run(int argc, char** argv) {
  CLI::App app("Hears the shape of things: spectra, a database of shapes, maps between them.",
               "timbre");
  timbre::cli::Context context;
  app.require_subcommand(1);
  app.set_version_flag("--version", timbre::cli::version_text());
  app.footer(
      "Each command explains itself and gives an example: timbre COMMAND --help\n"
      "Start with: timbre info MESH");
  add_commands(app, context);
  check_command_name(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked_for_help) {
    std::ostringstream text;
    (void)app.exit(asked_for_help, text, text);
    timbre::cli::print(text.str());
    return 0;
  } catch (const CLI::ParseError& wrong) {
    return complain(timbre::escape_control(wrong.what()) + "; see timbre --help", 2);
  }
  return context.exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  timbre::cli::hold_standard_streams();
  timbre::cli::catch_interrupts();
  try {
    return run(argc, argv);
  } catch (const Error& error) {
    return complain(error.what(), exit_code(error.kind()));
  } catch (const std::bad_alloc&) {
    return complain(
        "memory: not enough; a smaller mesh, fewer eigenpairs (-k) or fewer threads "
        "need less",
        1);
  } catch (const std::exception& other) {
    return complain(std::string("internal error: ") + other.what(), 1);
  }
}
