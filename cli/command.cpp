#include "timbre/cli/command.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <system_error>

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

void write_all(int descriptor, std::string_view bytes, const char* name) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      throw Error(ErrorKind::io, "", name, std::generic_category().message(errno));
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

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
      write("\r\x1b[K");
      shown_ = false;
    } else if (!over && passed > 1.0) {
      std::string line = "\r\x1b[K" + step.phase + " " + std::to_string(step.done);
      if (step.total > 0) line += "/" + std::to_string(step.total);
      if (step.done > 0 && step.total > step.done) {
        const auto done = static_cast<double>(step.done);
        line +=
            ", " + duration(passed * static_cast<double>(step.total - step.done) / done) + " left";
      }
      write(line);
      shown_ = true;
    }
    return !interrupted();
  }

  ~TerminalProgress() {
    if (shown_) write("\r\x1b[K");
  }

 private:
  static void write(const std::string& text) {
    // A progress line that cannot be shown is no reason to fail.
    [[maybe_unused]] const ssize_t ignored = ::write(STDERR_FILENO, text.data(), text.size());
  }

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
    write_all(STDOUT_FILENO, document.dump() + "\n", "standard output");
  } else {
    write_all(STDOUT_FILENO, text, "standard output");
  }
}

void Context::write_result(const std::string& path, std::string_view bytes) const {
  if (path == "-") {
    write_all(STDOUT_FILENO, bytes, "standard output");
  } else {
    write_file(path, bytes, force);
  }
}

void Context::note(const std::string& line) const {
  if (!quiet) complain(line);
}

void Context::complain(const std::string& line) const {
  write_all(STDERR_FILENO, "timbre: " + escape_control(line) + "\n", "standard error");
}

void Context::say(const std::string& line) const {
  const bool to_stderr = json;
  write_all(to_stderr ? STDERR_FILENO : STDOUT_FILENO, escape_control(line) + "\n",
            to_stderr ? "standard error" : "standard output");
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
  command.add_option("--threads", context.threads, "threads to use; 0: all cores")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  if (output) {
    command.add_option("-o,--output", context.output,
                       "where the result goes; - for standard output");
    command.add_flag("--force", context.force, "let the result replace an existing file");
  }
}

MeshFile load_mesh(const Context& context, const std::string& path) {
  MeshFile file = read_mesh(path);
  for (const ReadWarning& warning : file.warnings) context.note(path + ": " + warning.message);
  return file;
}

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_interrupt;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
}

bool interrupted() { return interrupt_seen != 0; }

std::string utf8_or_replaced(std::string_view text) {
  // dump() with this handler replaces invalid sequences; the quotes come off again.
  const nlohmann::json value = std::string(text);
  return nlohmann::json::parse(value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace))
      .get<std::string>();
}

}  // namespace timbre::cli
