#include "timbre/cli/options.h"

#include <filesystem>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"

namespace timbre::cli {

void add_operator_options(CLI::App& command, OperatorOptions& options) {
  std::map<std::string, OperatorKind> kinds;
  for (const OperatorKind kind : kOperatorKinds) kinds[to_word(kind)] = kind;
  add_word_option(command, "--operator", options.kind, kinds, "the Laplacian");
  add_word_option(command, "--mass", options.mass,
                  {{"lumped", MassKind::lumped}, {"consistent", MassKind::consistent}},
                  "mass matrix of robust and cotan; lumped if not given");
}

void add_boundary_option(CLI::App& command, OperatorOptions& options) {
  add_word_option(
      command, "--boundary", options.boundary,
      {{"neumann", BoundaryKind::neumann}, {"dirichlet", BoundaryKind::dirichlet}},
      "at edges of one triangle: neumann, nothing flows out; dirichlet, functions are 0");
}

void add_up_option(CLI::App& command, UpAxis& up) {
  add_word_option(command, "--up", up,
                  {{"x", UpAxis::x},
                   {"y", UpAxis::y},
                   {"z", UpAxis::z},
                   {"-x", UpAxis::minus_x},
                   {"-y", UpAxis::minus_y},
                   {"-z", UpAxis::minus_z}},
                  "axis that points up in pictures");
}

CLI::Validator number_between(double low, double high) {
  const std::string range = to_text(low) + " to " + to_text(high);
  const auto complaint = [low, high, range](const std::string& text) {
    const std::optional<double> value = parse_double(text);
    if (value && *value >= low && *value <= high) return std::string();
    return "'" + text + "' is not in the range " + range;
  };
  return {complaint, range};
}

std::string array_format(const std::string& path) {
  if (path == "-") return "txt";
  const std::string ending = std::filesystem::path(path).extension().string();
  for (const char* known : {".npz", ".npy", ".mat", ".txt"}) {
    if (ending == known) return ending.substr(1);
  }
  throw Error(ErrorKind::bad_request, path, "output",
              "ending '" + ending + "' is unknown; .npz, .npy, .mat and .txt are written");
}

}  // namespace timbre::cli
