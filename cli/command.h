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
  ReadOptions read;    ///< of every mesh the command reads
  int exit_code = 0;   ///< set by commands that finish in doubt or in part

  /// Prints the command's one answer: `document` with --json, else `text`. Where the result
  /// itself went to standard output (-o -), the lines of `text` become notes.
  void answer(nlohmann::json document, std::string_view text) const;
  /// To be called before any work: refuses a result file that cannot be written, and -o -
  /// beside --json, which both want standard output.
  void require_output() const;
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

/// Adds --json and -q; with `output`, also -o and --force.
void add_common_options(CLI::App& command, Context& context, bool output);
/// Adds --threads, for commands whose work is shared out.
void add_threads_option(CLI::App& command, Context& context);
/// Adds --soup and --size-limit, for commands that read meshes.
void add_read_options(CLI::App& command, Context& context);

/// Reads a mesh. `-` is standard input, which Ctrl-C leaves.
[[nodiscard]] MeshFile read_mesh_file(const Context& context, const std::string& path);
/// The same, and notes its warnings.
[[nodiscard]] MeshFile load_mesh(const Context& context, const std::string& path);

/// Writes to standard output. A reader that went away (`| head`) is no failure: what it
/// does not want is dropped.
/// @throws Error  io for every other failure
void print(std::string_view text);

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

/// Puts /dev/null, opened the wrong way round, in place of standard streams that are closed:
/// no other file gets their numbers, and reading or writing them stays an error.
void hold_standard_streams();

/// Ctrl-C sets a flag, which `Context::progress` hands to running computations. Closed pipes and
/// limits on file sizes do not end the process.
void catch_interrupts();
[[nodiscard]] bool interrupted();

// One function per command, in commands/: adds the subcommand and its callback.
void add_align(CLI::App& timbre, Context& context);
void add_dataset(CLI::App& timbre, Context& context);
void add_db(CLI::App& timbre, Context& context);
void add_distance(CLI::App& timbre, Context& context);
void add_embed(CLI::App& timbre, Context& context);
void add_eval(CLI::App& timbre, Context& context);
void add_filter(CLI::App& timbre, Context& context);
void add_info(CLI::App& timbre, Context& context);
void add_match(CLI::App& timbre, Context& context);
void add_query(CLI::App& timbre, Context& context);
void add_render(CLI::App& timbre, Context& context);
void add_report(CLI::App& timbre, Context& context);
void add_signature(CLI::App& timbre, Context& context);
void add_spectrum(CLI::App& timbre, Context& context);
void add_symmetry(CLI::App& timbre, Context& context);

}  // namespace timbre::cli
