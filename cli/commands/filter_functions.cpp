#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"
#include "timbre/analysis/filter/spectral_filter.h"
#include "timbre/analysis/filter/spectral_gap.h"
#include "timbre/analysis/filter/spectral_transform.h"
#include "timbre/analysis/mesh/write_mesh.h"
#include "timbre/cli/array_input.h"
#include "timbre/cli/array_output.h"
#include "timbre/cli/commands/filter.h"
#include "timbre/cli/options.h"

namespace timbre::cli {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kPoorGap = 1e-4;

Error bad_option(const std::string& option, const std::string& cause) {
  return {ErrorKind::bad_request, "", option, cause};
}

struct Problem {
  TriangleMesh mesh;
  Operator op;
  Spectrum spectrum;
  MatrixXd functions;  ///< n x d: the coordinates, or those of --function
};

// What one of the options means for these eigenvalues.
struct Plan {
  const char* word = "";
  Transfer transfer;
  FilterOptions options;
  double gap = std::numeric_limits<double>::quiet_NaN();  ///< the poorest at a cut; null in JSON
};

bool writes_mesh(const FilterArguments& args) {
  return args.function.empty() && !args.coefficients;
}

MeshFormat mesh_format_for(const std::string& output) {
  return output == "-" ? MeshFormat::ply : mesh_format_of(output);
}

void require_outputs(const FilterArguments& args, const Context& context) {
  if (context.output.empty()) {
    if (writes_mesh(args) && !context.json) {
      throw bad_option("output",
                       "the filtered mesh needs a file, -o FILE; --json alone has figures");
    }
  } else if (writes_mesh(args)) {
    (void)mesh_format_for(context.output);
  } else {
    (void)array_format(context.output);
  }
  context.require_output();
}

void require_vertex_functions(const FilterArguments& args) {
  if (args.op.kind == OperatorKind::p2 || args.op.kind == OperatorKind::p3) {
    throw bad_option("--operator",
                     "p2 and p3 have values between vertices; filters need one of "
                     "the others");
  }
  if (args.op.boundary == BoundaryKind::dirichlet && args.function.empty()) {
    throw bad_option("--boundary", "coordinates are not 0 there; dirichlet is for --function");
  }
}

MatrixXd functions_of(const FilterArguments& args, const Context& context,
                      const TriangleMesh& mesh) {
  if (args.function.empty()) return mesh.vertices;
  MatrixXd table = read_table(context, args.function);
  return for_file(args.function, [&] {
    if (table.rows() != mesh.vertices.rows()) {
      throw Error(ErrorKind::bad_input, "", "",
                  "has " + std::to_string(table.rows()) + " rows, but the mesh has " +
                      std::to_string(mesh.vertices.rows()) + " vertices");
    }
    for (Index i = 0; i < table.rows(); ++i) {
      if (table.row(i).allFinite()) continue;
      throw Error(ErrorKind::bad_input, "", "row " + std::to_string(i), "is not finite");
    }
    return std::move(table);
  });
}

int eigenpairs_for(const FilterArguments& args, const Operator& op) {
  int wanted = args.count;
  if (args.low_pass) wanted = *args.low_pass + kFilterGuard;
  if (!args.band.empty()) wanted = args.band[1] + 1 + kFilterGuard;
  if (!args.stop.empty()) wanted = args.stop[1] + 1 + kFilterGuard;
  return std::max(wanted, count_zeros(op) + 1);
}

Problem pose(const FilterArguments& args, const Context& context) {
  Problem problem;
  problem.mesh = load_mesh(context, args.mesh).mesh;
  problem.functions = functions_of(args, context, problem.mesh);
  for_file(args.mesh, [&] {
    problem.op = compute_operator(problem.mesh, args.op);
    problem.spectrum = compute_spectrum(problem.op, {.count = eigenpairs_for(args, problem.op),
                                                     .threads = context.threads,
                                                     .progress = context.progress()});
  });
  return problem;
}

// Eigenvalues equal to those at the ends belong to the band.
Plan plan_band(const std::vector<int>& ends, const char* option, bool stop,
               const Eigen::VectorXd& values) {
  if (ends[1] >= values.size()) {
    throw bad_option(
        option, "the mesh has only " + std::to_string(values.size()) + " eigenfunctions, from 0");
  }
  const double low = values[ends[0]];
  const double high = values[ends[1]];
  Plan plan{.word = stop ? "stop" : "band",
            .transfer = band(low, high, stop ? 0.0 : 1.0, stop ? 1.0 : 0.0),
            .options = {.detail = stop ? 1.0 : 0.0}};
  const auto first = std::lower_bound(values.begin(), values.end(), low) - values.begin();
  const auto after = std::upper_bound(values.begin(), values.end(), high) - values.begin();
  plan.gap = std::fmin(relative_gap(values, first - 1), relative_gap(values, after - 1));
  return plan;
}

Plan plan_low_pass(int count, const Eigen::VectorXd& values) {
  const Index last = std::min<Index>(count, values.size()) - 1;
  Plan plan = plan_band({0, static_cast<int>(last)}, "--low-pass", false, values);
  plan.word = "low_pass";
  return plan;
}

// The table is of the surface at unit total area.
Transfer read_transfer(const FilterArguments& args, const Context& context, double area) {
  const MatrixXd table = read_table(context, args.transfer);
  return for_file(args.transfer, [&]() -> Transfer {
    if (table.cols() != 2) {
      throw Error(ErrorKind::bad_input, "", "",
                  "has " + std::to_string(table.cols()) +
                      " columns; a transfer function has two, lambda and factor");
    }
    return [area, at_unit_area = piecewise_linear(table)](double lambda) {
      return at_unit_area(area * lambda);
    };
  });
}

double detail_factor(Detail detail, const Transfer& transfer, const Eigen::VectorXd& values) {
  if (detail == Detail::keep) return 1.0;
  return detail == Detail::drop ? 0.0 : transfer(values[values.size() - 1]);
}

Plan plan_filter(const FilterArguments& args, const Context& context, const Problem& problem) {
  const Eigen::VectorXd& values = problem.spectrum.values;
  if (args.low_pass) return plan_low_pass(*args.low_pass, values);
  if (!args.band.empty()) return plan_band(args.band, "--band", false, values);
  if (!args.stop.empty()) return plan_band(args.stop, "--stop", true, values);
  Plan plan;
  if (args.smooth) {
    plan.word = "smooth";
    plan.transfer = heat(*args.smooth * problem.op.area);
  } else {
    plan.word = "transfer";
    plan.transfer = read_transfer(args, context, problem.op.area);
  }
  plan.options.detail = detail_factor(args.detail, plan.transfer, values);
  return plan;
}

nlohmann::json figures(const FilterArguments& args, const Problem& problem,
                       const Reconstruction& parts) {
  const Eigen::VectorXd& values = problem.spectrum.values;
  return {{"mesh", args.mesh},
          {"columns", problem.functions.cols()},
          {"eigenvalues", std::vector<double>(values.begin(), values.end())},
          {"energies", std::vector<double>(parts.energies.begin(), parts.energies.end())},
          {"detail_energy", parts.detail},
          {"errors", std::vector<double>(parts.errors.begin(), parts.errors.end())}};
}

// An array result: to its file, else into the document or onto standard output.
void answer_arrays(const Context& context, nlohmann::json document, std::string summary,
                   const std::vector<NamedMatrix>& arrays) {
  const MatrixXd& main = arrays.front().values;
  if (!context.output.empty()) {
    context.write_result(context.output, to_file_bytes(context.output, arrays));
    document["output"] = context.output;
    if (context.output != "-") summary += "wrote " + escape_control(context.output) + "\n";
    context.answer(document, summary);
    return;
  }
  if (context.json) document["values"] = to_json_rows(main);
  context.answer(document, context.json ? "" : to_rows_text(main));
}

void run_coefficients(const FilterArguments& args, const Context& context) {
  const Problem problem = pose(args, context);
  const Reconstruction parts =
      analyse_reconstruction(problem.spectrum, problem.op.mass, problem.functions);
  answer_arrays(
      context, figures(args, problem, parts), "",
      {{"coefficients", forward_transform(problem.spectrum, problem.op.mass, problem.functions)},
       {"eigenvalues", problem.spectrum.values},
       {"energies", parts.energies},
       {"errors", parts.errors}});
}

}  // namespace

void run_filter(const FilterArguments& args, const Context& context) {
  require_outputs(args, context);
  require_vertex_functions(args);
  if (args.coefficients) {
    run_coefficients(args, context);
    return;
  }
  Problem problem = pose(args, context);
  const Plan plan = plan_filter(args, context, problem);
  if (plan.gap < kPoorGap) {
    context.note(args.mesh + ": a cut lies between eigenvalues that differ by " +
                 to_short_text(100.0 * plan.gap) +
                 " % only: the result hangs on how they are told apart");
  }
  const Reconstruction parts =
      analyse_reconstruction(problem.spectrum, problem.op.mass, problem.functions);
  const double change = relative_change(problem.spectrum, parts, plan.transfer, plan.options);
  const MatrixXd filtered = apply_filter(problem.spectrum, problem.op.mass, problem.functions,
                                         plan.transfer, plan.options);
  nlohmann::json document = figures(args, problem, parts);
  document["filter"] = plan.word;
  document["detail"] = plan.options.detail;
  document["gap"] = plan.gap;
  document["change"] = change;
  std::string summary =
      "changed by " + to_short_text(100.0 * change) + " % of the variation about the mean\n";
  if (!writes_mesh(args)) {
    answer_arrays(context, std::move(document), std::move(summary), {{"values", filtered}});
    return;
  }
  if (!context.output.empty()) {
    problem.mesh.vertices = filtered;
    context.write_result(context.output,
                         to_mesh_bytes(problem.mesh, mesh_format_for(context.output)));
    document["output"] = context.output;
    if (context.output != "-") summary += "wrote " + escape_control(context.output) + "\n";
  }
  context.answer(document, summary);
}

}  // namespace timbre::cli
