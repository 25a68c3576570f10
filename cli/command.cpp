#include "timbre/cli/command.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <system_error>

#include "timbre/analysis/core/byte_source.h"
#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/output_file.h"

namespace timbre::cli {
namespace {

volatile std::sig_atomic_t interrupt_seen = 0;

void on_interrupt(int) {
  interrupt_seen = 1;
  // A second Ctrl-C ends the process at once; the store's transactions make that safe.
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

// 0, or the number of the error that stopped it.
int write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

// Words beside the result: that nobody can hear them is no reason to fail.
void tell(std::string_view text) { (void)write_all(STDERR_FILENO, text); }

std::string duration(double seconds) {
  const auto whole = std::lround(seconds);
  if (whole < 60) return std::to_string(whole) + " s";
  if (whole < 3600) return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
  return std::to_string(whole / 3600) + " h " + std::to_string(whole / 60 % 60) + " min";
}

// One line on the terminal, rewritten; nothing during the first second.
class TerminalProgress {
 public:
  bool operator()(const ProgressStep& step) {
    const auto now = std::chrono::steady_clock::now();
    if (step.phase != phase_) {
      phase_ = step.phase;
      start_ = now;
    }
    const double passed = std::chrono::duration<double>(now - start_).count();
    const bool over = step.total > 0 && step.done >= step.total;
    if (over && shown_) {
      tell("\r\x1b[K");
      shown_ = false;
    } else if (!over && passed > 1.0) {
      std::string line = "\r\x1b[K" + step.phase + " " + std::to_string(step.done);
      if (step.total > 0) line += "/" + std::to_string(step.total);
      if (step.done > 0 && step.total > step.done) {
        const auto done = static_cast<double>(step.done);
        line +=
            ", " + duration(passed * static_cast<double>(step.total - step.done) / done) + " left";
      }
      tell(line);
      shown_ = true;
    }
    return !interrupted();
  }

  ~TerminalProgress() {
    if (shown_) tell("\r\x1b[K");
  }

 private:
  std::string phase_;
  std::chrono::steady_clock::time_point start_;
  bool shown_ = false;
};

bool stderr_is_a_terminal() {
  const char* const term = std::getenv("TERM");  // NOLINT(concurrency-mt-unsafe): set by none
  return ::isatty(STDERR_FILENO) == 1 && (term == nullptr || std::string_view(term) != "dumb");
}

}  // namespace

void Context::answer(nlohmann::json document, std::string_view text) const {
  if (json) {
    document["schema"] = 1;
    // File names need not be UTF-8; JSON must.
    print(document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  } else if (output != "-") {
    print(text);
  } else {
    for (std::size_t end = 0; !text.empty(); text.remove_prefix(end)) {
      end = std::min(text.find('\n'), text.size() - 1) + 1;
      note(std::string(text.substr(0, text[end - 1] == '\n' ? end - 1 : end)));
    }
  }
}

void Context::require_output() const {
  if (output == "-" && json) {
    throw Error(ErrorKind::bad_request, "", "output",
                "standard output cannot hold both the result and the JSON document; -o FILE");
  }
  if (!output.empty() && output != "-") require_writable(output, force);
}

void Context::write_result(const std::string& path, std::string_view bytes) const {
  if (path == "-") {
    print(bytes);
  } else {
    write_file(path, bytes, force);
  }
}

void Context::note(const std::string& line) const {
  if (!quiet) complain(line);
}

void Context::complain(const std::string& line) const {
  tell("timbre: " + escape_control(line) + "\n");
}

void Context::say(const std::string& line) const {
  const std::string whole = escape_control(line) + "\n";
  json ? tell(whole) : print(whole);
}

Progress Context::progress() const {
  if (quiet || !stderr_is_a_terminal()) {
    return [](const ProgressStep&) { return !interrupted(); };
  }
  return [shown = std::make_shared<TerminalProgress>()](const ProgressStep& step) {
    return (*shown)(step);
  };
}

void add_common_options(CLI::App& command, Context& context, bool output) {
  command.add_flag("--json", context.json, "one JSON document on standard output");
  command.add_flag("-q,--quiet", context.quiet, "no progress and no notes");
  if (output) {
    // `-o "$unset"` must not lose the result.
    const auto name_is_there = [](const std::string& name) {
      return std::string(name.empty() ? "a name is missing" : "");
    };
    command
        .add_option("-o,--output", context.output, "where the result goes; - for standard output")
        ->check(name_is_there);
    command.add_flag("--force", context.force, "let the result replace an existing file");
  }
}

void add_threads_option(CLI::App& command, Context& context) {
  command.add_option("--threads", context.threads, "threads to use; 0: all cores")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
}

void add_read_options(CLI::App& command, Context& context) {
  command.add_flag("--soup", context.read.soup, "STL: keep the corners of all facets apart");
  command.add_option("--size-limit", context.read.size_limit, "bytes; larger files are refused")
      ->capture_default_str();
}

MeshFile read_mesh_file(const Context& context, const std::string& path) {
  if (path != "-") return read_mesh(path, context.read);
  const std::string bytes =
      read_bytes(path, {.size_limit = context.read.size_limit, .stop = interrupted});
  return read_mesh_bytes(bytes, path, context.read);
}

MeshFile load_mesh(const Context& context, const std::string& path) {
  MeshFile file = read_mesh_file(context, path);
  for (const ReadWarning& warning : file.warnings) {
    // Without faces the command itself will say that it cannot go on.
    if (warning.code != "no-faces") context.note(path + ": " + warning.message);
  }
  return file;
}

void print(std::string_view text) {
  const int code = write_all(STDOUT_FILENO, text);
  if (code == 0 || code == EPIPE) return;
  throw Error(ErrorKind::io, "", "standard output", std::generic_category().message(code));
}

void hold_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) != -1 || errno != EBADF) continue;
    // The lowest free number is taken: this one.
    (void)::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
}

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_interrupt;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // Both come back as errors of the write.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

bool interrupted() { return interrupt_seen != 0; }

}  // namespace timbre::cli
