#include "timbre/cli/commands/render_values.h"

#include <utility>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/signatures/heat_kernel.h"
#include "timbre/analysis/signatures/wave_kernel.h"
#include "timbre/cli/array_input.h"
#include "timbre/cli/options.h"

namespace timbre::cli {
namespace {

Error bad_option(const std::string& option, const std::string& cause) {
  return {ErrorKind::bad_request, "", option, cause};
}

// Numbers for the vertices, and what is known about them.
struct Values {
  Eigen::VectorXd numbers;
  std::string about;  ///< "eigenfunction 3"
  bool is_signed = false;
  double clip = 0.0;  ///< percent
};

Eigen::VectorXd column_of(const Eigen::MatrixXd& table, int column, int otherwise) {
  if (column < 0) column = otherwise;
  if (column < table.cols()) return table.col(column);
  throw bad_option("column", std::to_string(column) + " is none of the " +
                                 std::to_string(table.cols()) + ", from 0");
}

Values values_of_file(const RenderValues& args, const Context& context, const TriangleMesh& mesh) {
  const Eigen::MatrixXd table = read_table(context, args.file);
  return for_file(args.file, [&]() -> Values {
    if (table.rows() != mesh.vertices.rows()) {
      throw Error(ErrorKind::bad_input, "", "",
                  "has " + std::to_string(table.rows()) + " rows, but the mesh has " +
                      std::to_string(mesh.vertices.rows()) + " vertices");
    }
    return {column_of(table, args.column, 0), "values", false, 0.0};
  });
}

Values eigenfunction_of(const RenderValues& args, const Context& context,
                        const TriangleMesh& mesh) {
  const Operator op = compute_operator(mesh, args.op);
  const Spectrum spectrum = compute_spectrum(op, {.count = *args.eigenfunction + 1,
                                                  .certify = false,
                                                  .threads = context.threads,
                                                  .progress = context.progress()});
  if (*args.eigenfunction >= spectrum.vectors.cols()) {
    throw bad_option("eigenfunction",
                     "the mesh has only " + std::to_string(spectrum.vectors.cols()) + ", from 0");
  }
  return {spectrum.vectors.col(*args.eigenfunction).head(op.vertices),
          "eigenfunction " + std::to_string(*args.eigenfunction), true, 0.0};
}

// Without --column a time a third of the way, where limbs show, or an energy in the middle.
Values signature_of(const RenderValues& args, const Context& context, const TriangleMesh& mesh) {
  const Operator op = compute_operator(mesh, args.op);
  const int zeros = count_zeros(op);
  Spectrum found = compute_spectrum(op, {.count = args.count + zeros,
                                         .certify = false,
                                         .threads = context.threads,
                                         .progress = context.progress()});
  const Spectrum spectrum = at_unit_area(at_vertices(std::move(found), op), op.area);
  const Eigen::MatrixXd table =
      args.signature == "hks"
          ? compute_heat_kernel_signature(spectrum, heat_kernel_times(spectrum))
          : compute_wave_kernel_signature(spectrum, wave_kernel_bands(spectrum));
  const int otherwise = static_cast<int>(table.cols()) / (args.signature == "hks" ? 3 : 2);
  return {column_of(table, args.column, otherwise),
          args.signature + " column " + std::to_string(args.column < 0 ? otherwise : args.column),
          false, 1.0};
}

std::optional<Values> chosen_values(const RenderValues& args, const Context& context,
                                    const TriangleMesh& mesh) {
  if (!args.file.empty()) return values_of_file(args, context, mesh);
  if (args.eigenfunction) return eigenfunction_of(args, context, mesh);
  if (!args.signature.empty()) return signature_of(args, context, mesh);
  return std::nullopt;
}

ColourMapKind colour_map_for(const RenderValues& args, const Values& values) {
  if (args.colours == "diverging") return ColourMapKind::diverging;
  if (args.colours == "sequential") return ColourMapKind::sequential;
  if (args.colours == "categorical") return ColourMapKind::categorical;
  return values.is_signed ? ColourMapKind::diverging : suggest_colour_map(values.numbers);
}

// Levels part the range into equal steps: one lies in the middle, at 0 where the range is
// symmetric.
std::vector<double> levels_between(double low, double high, int count) {
  std::vector<double> levels;
  for (int i = 1; i <= count; ++i) {
    const double share = static_cast<double>(i) / (count + 1);
    levels.push_back((1.0 - share) * low + share * high);
  }
  return levels;
}

}  // namespace

const char* to_word(ColourMapKind kind) {
  switch (kind) {
    case ColourMapKind::diverging:
      return "diverging";
    case ColourMapKind::sequential:
      return "sequential";
    case ColourMapKind::categorical:
      break;
  }
  return "categorical";
}

void add_value_options(CLI::App& command, RenderValues& args) {
  CLI::Option* const values = command.add_option(
      "--values", args.file, "numbers for the vertices: .npy, or text, a row for each vertex");
  CLI::Option* const eigenfunction =
      command
          .add_option("--eigenfunction", args.eigenfunction,
                      "show this eigenfunction; 0 is the constant one")
          ->check(CLI::Range(0, 100000));
  CLI::Option* const signature =
      command.add_option("--signature", args.signature, "show a signature: hks or wks")
          ->check(CLI::IsMember({"hks", "wks"}));
  values->excludes(eigenfunction)->excludes(signature);
  eigenfunction->excludes(signature);
  command
      .add_option("--column", args.column,
                  "of --values (default 0), or the time or energy of --signature")
      ->check(CLI::Range(0, 1000000));
  command.add_option("-k,--count", args.count, "eigenvalues that --signature uses")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command
      .add_option("--colours", args.colours,
                  "auto, diverging (signed, 0 in the middle), sequential or categorical")
      ->check(CLI::IsMember({"auto", "diverging", "sequential", "categorical"}))
      ->capture_default_str();
  command
      .add_option("--clip", args.clip,
                  "percent of the values at each end that share the end's colour; default: 1 for "
                  "--signature, else 0")
      ->check(number_between(0.0, 49.0));
  command
      .add_option("--lines", args.lines,
                  "draw so many lines of equal value; default: 1, at 0, for diverging colours")
      ->check(CLI::Range(0, 1000));
  add_operator_options(command, args.op);
  add_boundary_option(command, args.op);
}

std::optional<ShownValues> show_values(const RenderValues& args, const Context& context,
                                       SurfaceLook& look) {
  std::optional<Values> values = chosen_values(args, context, look.mesh);
  if (!values) return std::nullopt;
  const ColourMapKind kind = colour_map_for(args, *values);
  ColourScale scale =
      scale_to_table(values->numbers, kind, args.clip < 0.0 ? values->clip : args.clip);
  look.field = ColourField{std::move(scale.places), make_colour_table(kind),
                           kind == ColourMapKind::categorical};
  const int lines = args.lines >= 0 ? args.lines : (kind == ColourMapKind::diverging ? 1 : 0);
  if (lines > 0 && kind != ColourMapKind::categorical && scale.low < scale.high) {
    look.lines = Isolines{std::move(values->numbers), levels_between(scale.low, scale.high, lines)};
  }
  return ShownValues{values->about, kind, scale.low, scale.high};
}

}  // namespace timbre::cli
