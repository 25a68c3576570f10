#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/progress.h"
#include "timbre/analysis/mesh/read_mesh.h"

namespace timbre::cli {

/// What every command shares: how to answer, how to show progress, when to stop.
struct Context {
  bool json = false;   ///< one JSON document on stdout instead of text
  bool quiet = false;  ///< no progress, no notes
  bool force = false;  ///< results may replace existing files
  int threads = 0;     ///< 0: all cores
  std::string output;  ///< -o; empty: not given, "-": stdout
  int exit_code = 0;   ///< set by commands that finish in doubt or in part

  /// Prints the command's one answer: `document` with --json, else `text`.
  void answer(nlohmann::json document, std::string_view text) const;
  /// Writes a result file, or stdout for "-"; without --force an existing file is an error.
  void write_result(const std::string& path, std::string_view bytes) const;
  /// A line for a person on stderr, unless --quiet.
  void note(const std::string& line) const;
  /// A failure that does not end the command, on stderr even with --quiet.
  void complain(const std::string& line) const;
  /// A line that belongs to the result: stdout, or stderr when stdout holds JSON.
  void say(const std::string& line) const;
  /// Progress with ETA on a terminal; stops the computation after Ctrl-C.
  [[nodiscard]] Progress progress() const;
};

/// Adds --json, -q, --threads; with `output`, also -o and --force.
void add_common_options(CLI::App& command, Context& context, bool output);

/// Reads a mesh and notes its warnings. `-` is standard input.
[[nodiscard]] MeshFile load_mesh(const Context& context, const std::string& path);

/// Runs `work`; an error that names no file is told again with this one's name.
template <typename Work>
auto for_file(const std::string& path, Work&& work) {
  try {
    return std::forward<Work>(work)();
  } catch (const Error& error) {
    if (!error.file().empty() || error.kind() == ErrorKind::cancelled) throw;
    throw error.in_file(path);
  }
}

/// Ctrl-C sets a flag, which `Context::progress` hands to running computations.
void catch_interrupts();
[[nodiscard]] bool interrupted();

/// Text as valid UTF-8: JSON can hold nothing else, file names can.
[[nodiscard]] std::string utf8_or_replaced(std::string_view text);

// One function per command, in commands/: adds the subcommand and its callback.
void add_db(CLI::App& timbre, Context& context);
void add_embed(CLI::App& timbre, Context& context);
void add_eval(CLI::App& timbre, Context& context);
void add_match(CLI::App& timbre, Context& context);
void add_query(CLI::App& timbre, Context& context);
void add_signature(CLI::App& timbre, Context& context);
void add_spectrum(CLI::App& timbre, Context& context);
void add_symmetry(CLI::App& timbre, Context& context);
void add_info(CLI::App& app, Context& context);

}  // namespace timbre::cli
