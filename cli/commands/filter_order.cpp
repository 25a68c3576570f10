#include <cmath>

#include "timbre/analysis/core/array_file.h"
#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"
#include "timbre/analysis/filter/fiedler_order.h"
#include "timbre/analysis/filter/nodal_domains.h"
#include "timbre/analysis/filter/spectral_gap.h"
#include "timbre/cli/array_output.h"
#include "timbre/cli/commands/filter.h"
#include "timbre/cli/commands/map_output.h"
#include "timbre/cli/options.h"

namespace timbre::cli {
namespace {

constexpr double kPoorGap = 0.01;

// Whole numbers, one for each vertex, as a result file; in `.npz` with real ones beside them.
std::string to_bytes(const std::string& path, const std::string& name,
                     const std::vector<std::int32_t>& numbers, bool is_index,
                     const std::string& beside, const Eigen::VectorXd& values) {
  const std::string format = array_format(path);
  if (format == "txt") return to_lines(numbers);
  if (format == "npy") return to_npy_bytes(numbers);
  return to_archive(path, {{name, to_npy_bytes(numbers), is_index}, {beside, to_npy(values)}});
}

void require_outputs(const Context& context) {
  if (!context.output.empty()) (void)array_format(context.output);
  context.require_output();
}

std::string wrote(const std::string& output) {
  return output.empty() || output == "-" ? "" : "wrote " + escape_control(output) + "\n";
}

}  // namespace

void run_fiedler_order(const FilterArguments& args, const Context& context) {
  require_outputs(context);
  const MeshFile file = load_mesh(context, args.mesh);
  const FiedlerOrder found = for_file(args.mesh, [&] {
    return compute_fiedler_order(compute_operator(file.mesh, args.op), context.progress(),
                                 context.threads);
  });
  nlohmann::json components = nlohmann::json::array();
  for (Eigen::Index c = 0; c < found.values.size(); ++c) {
    components.push_back({{"eigenvalue", found.values[c]}, {"gap", found.gaps[c]}});
  }
  if (found.gaps.minCoeff() < kPoorGap) {
    context.note(args.mesh + ": lambda_1 and lambda_2 differ by " +
                 to_short_text(100.0 * found.gaps.minCoeff()) +
                 " % only: the order is one of many as good");
  }
  nlohmann::json document = {{"mesh", args.mesh}, {"components", components}};
  if (context.output.empty()) {
    document["order"] = found.order;
    context.answer(document, to_lines(found.order));
    return;
  }
  context.write_result(
      context.output, to_bytes(context.output, "order", found.order, true, "vector", found.vector));
  document["output"] = context.output;
  context.answer(document, wrote(context.output));
}

void run_nodal_domains(const FilterArguments& args, const Context& context) {
  require_outputs(context);
  const int number = *args.nodal;
  const MeshFile file = load_mesh(context, args.mesh);
  const Spectrum spectrum = for_file(args.mesh, [&] {
    const Operator op = compute_operator(file.mesh, args.op);
    return at_vertices(
        compute_spectrum(
            op, {.count = number + 2, .threads = context.threads, .progress = context.progress()}),
        op);
  });
  if (number >= spectrum.values.size()) {
    throw Error(
        ErrorKind::bad_request, "", "--nodal",
        "the mesh has only " + std::to_string(spectrum.values.size()) + " eigenfunctions, from 0");
  }
  const Eigen::VectorXd function = spectrum.vectors.col(number);
  const NodalDomains found = find_nodal_domains(file.mesh.faces, function);
  const double below = number == 0 ? 1.0 : relative_gap(spectrum.values, number - 1);
  const double gap = std::fmin(below, relative_gap(spectrum.values, number));
  if (gap < kPoorGap) {
    context.note(args.mesh + ": eigenvalue " + std::to_string(number) + " is " +
                 to_short_text(100.0 * gap) +
                 " % from the next: other eigenfunctions there may have other domains");
  }
  if (!context.output.empty()) {
    context.write_result(context.output, to_bytes(context.output, "labels", found.label, false,
                                                  "function", function));
  }
  nlohmann::json document = {{"mesh", args.mesh},
                             {"eigenfunction", number},
                             {"eigenvalue", spectrum.values[number]},
                             {"gap", gap},
                             {"domains", found.count},
                             {"weak_domains", found.weak_count},
                             {"courant_bound", number + 1}};
  if (!context.output.empty()) document["output"] = context.output;
  context.answer(document, "eigenfunction " + std::to_string(number) + ": " +
                               std::to_string(found.count) +
                               (found.count == 1 ? " nodal domain" : " nodal domains") +
                               ", by Courant at most " + std::to_string(number + 1) + "\n" +
                               wrote(context.output));
}

}  // namespace timbre::cli
