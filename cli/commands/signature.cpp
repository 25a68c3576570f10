#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/embedding/embedding.h"
#include "timbre/analysis/signatures/distance_quantiles.h"
#include "timbre/analysis/signatures/heat_kernel.h"
#include "timbre/analysis/signatures/shape_dna.h"
#include "timbre/analysis/signatures/wave_kernel.h"
#include "timbre/cli/array_output.h"
#include "timbre/cli/command.h"
#include "timbre/cli/options.h"

namespace timbre::cli {
namespace {

enum class SignatureKind : std::uint8_t { dna, dna_raw, dna_i, dna_weyl, dna_log, hks, wks, gps };

struct Arguments {
  std::string mesh;
  SignatureKind signature = SignatureKind::hks;
  EmbeddingOptions embedding;
  int count = 100;
  bool count_given = false;
  OperatorOptions op;
};

constexpr int kMostGpsDimensions = 25;

struct Solved {
  Operator op;
  Spectrum spectrum;  ///< at unit total area; `count` eigenvalues that are not zero
};

Solved solve(const Arguments& args, const Context& context) {
  Solved solved;
  const MeshFile file = load_mesh(context, args.mesh);
  for_file(args.mesh, [&] {
    solved.op = compute_operator(file.mesh, args.op);
    const int zeros = count_zeros(solved.op);
    Spectrum found = compute_spectrum(
        solved.op,
        {.count = args.count + zeros, .threads = context.threads, .progress = context.progress()});
    solved.spectrum = at_unit_area(at_vertices(std::move(found), solved.op), solved.op.area);
  });
  const Eigen::Index used = solved.spectrum.values.size() - solved.spectrum.zeros;
  if (used < args.count) {
    context.note(args.mesh + ": has only " + std::to_string(used) +
                 " eigenvalues that are not 0; these are used");
  }
  return solved;
}

std::vector<NamedMatrix> signature_of(const Solved& solved, const Arguments& args) {
  const Spectrum& spectrum = solved.spectrum;
  switch (args.signature) {
    case SignatureKind::dna:
      return {{"dna", compute_shape_dna(spectrum, ShapeDnaForm::plain, args.count)}};
    case SignatureKind::dna_raw:
      return {{"dna_raw",
               compute_shape_dna(spectrum, ShapeDnaForm::plain, args.count) / solved.op.area}};
    case SignatureKind::dna_i:
      return {{"dna_i", compute_shape_dna(spectrum, ShapeDnaForm::per_index, args.count)}};
    case SignatureKind::dna_weyl:
      return {{"dna_weyl", compute_shape_dna(spectrum, ShapeDnaForm::weyl, args.count)}};
    case SignatureKind::dna_log:
      return {{"dna_log", compute_shape_dna(spectrum, ShapeDnaForm::logarithm, args.count)}};
    case SignatureKind::hks: {
      const Eigen::VectorXd times = heat_kernel_times(spectrum);
      return {{"hks", compute_heat_kernel_signature(spectrum, times)}, {"times", times}};
    }
    case SignatureKind::wks: {
      const WaveKernelBands bands = wave_kernel_bands(spectrum);
      return {{"wks", compute_wave_kernel_signature(spectrum, bands)},
              {"energies", bands.energies}};
    }
    case SignatureKind::gps:
      break;
  }
  const Eigen::MatrixXd gps =
      compute_embedding(spectrum, {.dimensions = std::min(args.count, kMostGpsDimensions)});
  return {{"gps_q", compute_distance_quantiles(gps, solved.op.lumped_mass)}};
}

// Without -o the numbers are the answer themselves.
void answer(const std::vector<NamedMatrix>& matrices, const Arguments& args,
            const Context& context) {
  const NamedMatrix& main = matrices.front();
  nlohmann::json document = {{"mesh", args.mesh},
                             {"kind", main.name},
                             {"rows", main.values.rows()},
                             {"columns", main.values.cols()}};
  if (!context.output.empty()) {
    context.write_result(context.output, to_file_bytes(context.output, matrices));
    document["output"] = context.output;
    context.answer(document, "");
    return;
  }
  if (context.json) {
    for (const NamedMatrix& matrix : matrices) {
      document[matrix.name == main.name ? "values" : matrix.name] = to_json_rows(matrix.values);
    }
  }
  context.answer(document, context.json ? "" : to_rows_text(main.values));
}

// Reads, solves, and gives the rest of the work the file's name.
template <typename Work>
void run(const Arguments& args, const Context& context, const Work& work) {
  if (!context.output.empty()) (void)array_format(context.output);
  context.require_output();
  const Solved solved = solve(args, context);
  answer(for_file(args.mesh, [&] { return work(solved); }), args, context);
}

void run_signature(const Arguments& args, const Context& context) {
  if (args.signature == SignatureKind::gps && args.count_given && args.count > kMostGpsDimensions) {
    context.note("gps uses the first " + std::to_string(kMostGpsDimensions) + " eigenfunctions");
  }
  run(args, context, [&args](const Solved& solved) { return signature_of(solved, args); });
}

void run_embedding(const Arguments& args, const Context& context) {
  run(args, context, [&args](const Solved& solved) -> std::vector<NamedMatrix> {
    EmbeddingOptions options = args.embedding;
    options.dimensions = args.count;
    return {{"coordinates", compute_embedding(solved.spectrum, options)},
            {"eigenvalues", solved.spectrum.values}};
  });
}

void add_shared_options(CLI::App& command, Arguments& args, Context& context) {
  command.add_option("MESH", args.mesh, "mesh file, or - for standard input")->required();
  command.add_option("-k,--count", args.count, "eigenvalues used, zeros not counted")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  add_operator_options(command, args.op);
  add_boundary_option(command, args.op);
  add_read_options(command, context);
  add_threads_option(command, context);
  add_common_options(command, context, true);
}

}  // namespace

void add_signature(CLI::App& timbre, Context& context) {
  auto args = std::make_shared<Arguments>();
  CLI::App& command = *timbre.add_subcommand(
      "signature", "Descriptors of a mesh (dna..., gps) or of its vertices (hks, wks)");
  add_word_option(command, "--kind", args->signature,
                  {{"dna", SignatureKind::dna},
                   {"dna_raw", SignatureKind::dna_raw},
                   {"dna_i", SignatureKind::dna_i},
                   {"dna_weyl", SignatureKind::dna_weyl},
                   {"dna_log", SignatureKind::dna_log},
                   {"hks", SignatureKind::hks},
                   {"wks", SignatureKind::wks},
                   {"gps", SignatureKind::gps}},
                  "which descriptor");
  add_shared_options(command, *args, context);
  command.footer(
      "-o F.npy, F.npz or F.mat (with times or energies) or F.txt. dna are the eigenvalues at unit "
      "total\n"
      "area, dna_raw at the mesh's own scale; all others are at unit total area. gps takes the\n"
      "first 25 eigenfunctions at most.\n"
      "Example:\n  timbre signature horse.ply --kind wks -k 200 -o horse_wks.npz");
  command.callback([args, &command, &context] {
    args->count_given = command.count("--count") > 0;
    run_signature(*args, context);
  });
}

void add_embed(CLI::App& timbre, Context& context) {
  auto args = std::make_shared<Arguments>();
  CLI::App& command = *timbre.add_subcommand(
      "embed", "Spectral coordinates of the vertices: gps, diffusion, biharmonic");
  add_word_option(command, "--kind", args->embedding.kind,
                  {{"gps", EmbeddingKind::gps},
                   {"diffusion", EmbeddingKind::diffusion},
                   {"biharmonic", EmbeddingKind::biharmonic}},
                  "which coordinates");
  command.add_option("--time", args->embedding.time, "diffusion only, in units of total area")
      ->capture_default_str()
      ->check(number_between(1e-300, 1e300));
  add_shared_options(command, *args, context);
  command.footer(
      "-o F.npy, F.npz or F.mat (with eigenvalues) or F.txt: n x k, at unit total area.\n"
      "Example:\n  timbre embed horse.ply --kind biharmonic -k 30 -o horse.npy");
  command.callback([args, &context] { run_embedding(*args, context); });
}

}  // namespace timbre::cli
