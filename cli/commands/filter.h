#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "timbre/analysis/operators/operator.h"
#include "timbre/cli/command.h"

namespace timbre::cli {

/// What becomes of the part of a function beyond the eigenfunctions computed.
enum class Detail : std::uint8_t { last, keep, drop };

/// What `timbre filter` was asked; exactly one of the first group.
struct FilterArguments {
  std::optional<int> low_pass;  ///< eigenfunctions kept
  std::vector<int> band, stop;  ///< first and last eigenfunction
  std::optional<double> smooth;
  std::string transfer;
  bool coefficients = false;
  bool fiedler = false;
  std::optional<int> nodal;

  std::string mesh;
  std::string function;  ///< empty: the coordinates
  int count = 100;
  Detail detail = Detail::last;
  OperatorOptions op;
};

/// Eigenpairs computed beyond those asked for: among them ends the eigenspace that a cut is in.
inline constexpr int kFilterGuard = 10;

// The three kinds of work, each with its own answer.
void run_filter(const FilterArguments& args, const Context& context);
void run_fiedler_order(const FilterArguments& args, const Context& context);
void run_nodal_domains(const FilterArguments& args, const Context& context);

}  // namespace timbre::cli
