#include <algorithm>
#include <array>
#include <iomanip>
#include <memory>
#include <sstream>
#include <string>
#include <utility>

#include "timbre/analysis/core/array_file.h"
#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"
#include "timbre/analysis/core/output_file.h"
#include "timbre/analysis/core/stopwatch.h"
#include "timbre/analysis/operators/finite_elements.h"
#include "timbre/analysis/spectrum/spectrum.h"
#include "timbre/cli/array_output.h"
#include "timbre/cli/command.h"
#include "timbre/cli/commands/stream_spectrum.h"
#include "timbre/cli/options.h"
#include "timbre/cli/version.h"

namespace timbre::cli {
namespace {

struct Arguments {
  std::string mesh;
  OperatorOptions op;
  SpectrumOptions spectrum;
  StreamOptions stream;
  bool timings = false;
};

void add_sparse(std::vector<NamedArray>& arrays, const std::string& name,
                const SparseMatrix& matrix) {
  const Eigen::Index nonzeros = matrix.nonZeros();
  using Eigen::Map;
  using Eigen::VectorXd;
  using Eigen::VectorXi;
  arrays.push_back(
      {name + "_data", to_npy(VectorXd(Map<const VectorXd>(matrix.valuePtr(), nonzeros)))});
  arrays.push_back({name + "_indices",
                    to_npy(VectorXi(Map<const VectorXi>(matrix.innerIndexPtr(), nonzeros))), true});
  arrays.push_back({name + "_indptr", to_npy(VectorXi(Map<const VectorXi>(matrix.outerIndexPtr(),
                                                                          matrix.cols() + 1)))});
  const auto rows = static_cast<int>(matrix.rows());
  arrays.push_back({name + "_shape", to_npy(VectorXi(Eigen::Vector2i(rows, rows)))});
}

// Where the rows after those of the vertices are; empty if there are none.
Points nodes_of(const TriangleMesh& mesh, const Operator& op) {
  if (op.kind != OperatorKind::p2 && op.kind != OperatorKind::p3) return {};
  const int degree = op.kind == OperatorKind::p2 ? 2 : 3;
  return node_positions(number_nodes(mesh.faces, op.vertices, degree), mesh.vertices);
}

std::string archive(const TriangleMesh& mesh, const Operator& op, const Spectrum& found,
                    const std::string& output) {
  std::vector<NamedArray> arrays = {
      {"vertices", to_npy(mesh.vertices)},    {"faces", to_npy(mesh.faces), true},
      {"evals", to_npy(found.values)},        {"evecs", to_npy(found.vectors)},
      {"residuals", to_npy(found.residuals)}, {"mass", to_npy(op.lumped_mass)}};
  add_sparse(arrays, "W", op.stiffness);
  if (op.mass_kind == MassKind::consistent) add_sparse(arrays, "M", op.mass);
  const Points nodes = nodes_of(mesh, op);
  if (nodes.rows() > 0) arrays.push_back({"nodes", to_npy(nodes)});
  const int certified = found.certificate ? 1 : 0;
  arrays.push_back({"certified", to_npy(Eigen::VectorXi(Eigen::VectorXi::Constant(1, certified)))});
  arrays.push_back({"timbre_version", to_npy(version_number())});
  return to_archive(output, arrays);
}

std::string lines(const Eigen::VectorXd& values) {
  std::string text;
  for (const double value : values) text += to_text(value) + "\n";
  return text;
}

bool is_streamed(const Context& context) {
  return !context.output.empty() && context.output != "-" && array_format(context.output) == "npy";
}

void require_outputs(const Arguments& args, const Context& context) {
  if (context.output.empty()) return;
  (void)array_format(context.output);
  context.require_output();
  if (is_streamed(context)) return require_stream_can_begin(context, args.stream);
  if (args.stream.resume || args.stream.type != ElementType::float64) {
    throw Error(ErrorKind::bad_request, "", args.stream.resume ? "--resume" : "--float32",
                "is for eigenfunctions in a file: -o F.npy");
  }
}

void write_spectrum(const Context& context, const TriangleMesh& mesh, const Operator& op,
                    const Spectrum& found) {
  const std::string format = array_format(context.output);
  if (format == "npz" || format == "mat") {
    context.write_result(context.output, archive(mesh, op, found, context.output));
  } else {
    context.write_result(context.output, lines(found.values));
  }
}

nlohmann::json to_json(const std::optional<Certificate>& certificate) {
  if (!certificate) return nullptr;
  nlohmann::json shifts = nlohmann::json::array();
  for (const InertiaCount& count : certificate->shifts) {
    shifts.push_back({{"component", count.component},
                      {"shift", count.shift},
                      {"below", count.below},
                      {"pairs", count.pairs}});
  }
  return {{"bound", certificate->bound}, {"count", certificate->count}, {"shifts", shifts}};
}

std::string to_prose(const Spectrum& found, const std::string& output) {
  if (output.empty()) return lines(found.values);
  return output == "-" ? "" : "wrote " + escape_control(output) + "\n";
}

nlohmann::json describe(const std::string& mesh, const Operator& op, const Spectrum& found) {
  return {{"mesh", mesh},
          {"eigenvalues", std::vector<double>(found.values.begin(), found.values.end())},
          {"zeros", found.zeros},
          {"residual", found.residuals.maxCoeff()},
          {"orthonormality", found.orthonormality},
          {"certificate", to_json(found.certificate)},
          {"operator", to_word(op.kind)},
          {"mass", to_word(op.mass_kind)},
          {"boundary", to_word(op.boundary)},
          {"area", op.area},
          {"flips", op.flips},
          {"components_left_out", op.components_left_out},
          {"mollified_by", op.mollified_by}};
}

struct NamedPhase {
  const char* name;
  double SpectrumPhases::*seconds;
};

constexpr std::array kPhases = {NamedPhase{"ordering", &SpectrumPhases::ordering},
                                NamedPhase{"factorization", &SpectrumPhases::factorization},
                                NamedPhase{"solves", &SpectrumPhases::solves},
                                NamedPhase{"orthogonalization", &SpectrumPhases::orthogonalization},
                                NamedPhase{"projection", &SpectrumPhases::projection},
                                NamedPhase{"vectors", &SpectrumPhases::vectors},
                                NamedPhase{"checks", &SpectrumPhases::checks}};

nlohmann::json to_json(const SpectrumPhases& phases) {
  nlohmann::json seconds;
  for (const NamedPhase& phase : kPhases) seconds[phase.name] = phases.*phase.seconds;
  return seconds;
}

// Seconds, one step a line, phases of the spectrum below it.
void say_timings(const nlohmann::json& timings, const Context& context) {
  const auto say = [&](const std::string& name, double seconds) {
    std::ostringstream line;
    line << std::left << std::setw(20) << name << std::right << std::fixed << std::setprecision(3)
         << std::setw(9) << seconds << " s";
    context.complain(line.str());
  };
  for (const char* const step : {"read", "operator", "spectrum"}) say(step, timings[step]);
  for (const NamedPhase& phase : kPhases) {
    say(std::string("  ") + phase.name, timings["phases"][phase.name]);
  }
}

void run(const Arguments& args, const Context& context) {
  require_outputs(args, context);
  Stopwatch watch;
  nlohmann::json timings;
  const MeshFile file = load_mesh(context, args.mesh);
  timings["read"] = watch.lap();
  const Operator op = for_file(args.mesh, [&] { return compute_operator(file.mesh, args.op); });
  timings["operator"] = watch.lap();
  if (op.mollified_by > 0.0) {
    context.note(args.mesh + ": thin triangles: edge lengths raised by " +
                 to_short_text(op.mollified_by) + " (mollification)");
  }
  if (op.components_left_out > 0) {
    context.note(args.mesh + ": " + std::to_string(op.components_left_out) +
                 (op.components_left_out == 1 ? " component has" : " components have") +
                 " no area and no part in the spectrum");
  }
  SpectrumOptions options = args.spectrum;
  options.threads = context.threads;
  options.progress = context.progress();
  const Eigen::Index rows = op.stiffness.rows();
  require_fits(context.output, rows, std::min<Eigen::Index>(options.count, rows));
  const auto document_of = [&](const Spectrum& found) { return describe(args.mesh, op, found); };
  const Spectrum found = for_file(args.mesh, [&] {
    return is_streamed(context) ? stream_spectrum(context, op, options, args.stream, document_of)
                                : compute_spectrum(op, options);
  });
  timings["spectrum"] = watch.lap();
  timings["phases"] = to_json(found.phases);
  if (found.values.size() < options.count) {
    context.note(args.mesh + ": has only " + std::to_string(found.values.size()) +
                 " eigenpairs, one for each row of its matrices");
  }
  if (!context.output.empty() && !is_streamed(context)) {
    write_spectrum(context, file.mesh, op, found);
  }
  nlohmann::json document = document_of(found);
  if (args.timings) say_timings(timings, context);
  document["timings"] = std::move(timings);
  context.answer(std::move(document), to_prose(found, context.output));
}

}  // namespace

void add_spectrum(CLI::App& timbre, Context& context) {
  auto args = std::make_shared<Arguments>();
  CLI::App& command = *timbre.add_subcommand("spectrum", "Lowest eigenpairs of the Laplacian");
  command.add_option("MESH", args->mesh, "mesh file, or - for standard input")->required();
  command.add_option("-k,--count", args->spectrum.count, "eigenpairs wanted")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  add_operator_options(command, args->op);
  add_boundary_option(command, args->op);
  command
      .add_option(
          "--tolerance", args->spectrum.tolerance,
          "largest relative residual accepted; 0.01 takes two thirds of the time of the default")
      ->capture_default_str()
      ->check(number_between(1e-14, 1.0));
  command.add_flag("!--no-certify", args->spectrum.certify, "skip the proof that none is missing");
  command.add_flag_callback(
      "--float32", [args] { args->stream.type = ElementType::float32; },
      "eigenfunctions of F.npy in single precision");
  command.add_flag("--resume", args->stream.resume, "go on with an unfinished F.npy");
  command.add_flag("--timings", args->timings, "show on stderr where the time goes");
  add_read_options(command, context);
  add_threads_option(command, context);
  add_common_options(command, context, true);
  command.footer(
      "Without -o the eigenvalues are printed, one a line. F.npz or F.mat holds mesh, matrices "
      "and\n"
      "eigenpairs. F.npy takes the eigenfunctions as they are found, more than fit into memory;\n"
      "F.evals.npy and F.json, with the certificate, come beside it.\n"
      "Examples:\n  timbre spectrum horse.ply -k 200 -o horse.npz\n"
      "  timbre spectrum horse.ply -k 5000 --float32 -o horse.npy");
  command.callback([args, &context] { run(*args, context); });
}

}  // namespace timbre::cli
