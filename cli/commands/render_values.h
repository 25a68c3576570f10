#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "timbre/analysis/operators/operator.h"
#include "timbre/cli/command.h"
#include "timbre/cli/render/render.h"

namespace timbre::cli {

/// Which values of its vertices a picture shows, and how.
struct RenderValues {
  std::string file, signature;       ///< empty: not these
  std::optional<int> eigenfunction;  ///< none: not this
  int column = -1;                   ///< of a file or a signature; -1: not given
  int count = 100;                   ///< eigenvalues a signature uses
  std::string colours = "auto";
  double clip = -1.0;  ///< percent; -1: not given
  int lines = -1;      ///< -1: not given
  OperatorOptions op;
};

struct ShownValues {
  std::string about;  ///< "eigenfunction 3"
  ColourMapKind colours = ColourMapKind::sequential;
  double low = 0.0;   ///< the value at the colours' lower end
  double high = 0.0;  ///< and at the upper
};

/// `diverging`, `sequential` or `categorical`.
[[nodiscard]] const char* to_word(ColourMapKind kind);

/// --values, --eigenfunction or --signature, and how they are coloured.
void add_value_options(CLI::App& command, RenderValues& values);

/// Reads or computes the values asked for and puts them on the surface; nothing if none are.
[[nodiscard]] std::optional<ShownValues> show_values(const RenderValues& args,
                                                     const Context& context, SurfaceLook& look);

}  // namespace timbre::cli
