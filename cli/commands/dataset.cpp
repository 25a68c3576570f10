#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/cli/command.h"
#include "timbre/cli/commands/dataset.h"
#include "timbre/datasets/analytic.h"
#include "timbre/datasets/closed_form.h"

namespace timbre::cli {
namespace {

// A surface of one parameter: about how many vertices.
struct AnalyticKind {
  const char* name;
  const char* about;
  TriangleMesh (*make)(int vertices);
  std::vector<double> (*eigenvalues)(int count);  // null where no closed form is known
};

int root(double value) { return std::max(1, static_cast<int>(std::lround(std::sqrt(value)))); }

constexpr std::array kAnalytic = {
    AnalyticKind{"sphere", "Unit sphere", [](int n) { return make_sphere(root((n - 2) / 10.0)); },
                 sphere_eigenvalues},
    AnalyticKind{"torus", "Torus of revolution, radii 1 and 0.4",
                 [](int n) {
                   const int tube = std::max(3, root(0.4 * n));
                   return make_torus(1.0, 0.4, std::max(3, n / tube), tube);
                 },
                 nullptr},
    AnalyticKind{"disk", "Unit disk", [](int n) { return make_disk(root(n / 3.0)); },
                 disk_eigenvalues},
    AnalyticKind{"rectangle", "Rectangle [0, 2] x [0, 1]",
                 [](int n) {
                   const int cells = root(n / 2.0);
                   return make_rectangle(2.0, 1.0, 2 * cells, cells);
                 },
                 [](int count) { return rectangle_eigenvalues(2.0, 1.0, count); }},
    AnalyticKind{"cylinder", "Open tube of radius 1 and height 2",
                 [](int n) {
                   // Triangles about equilateral: rows lie sqrt(3) / 2 steps apart.
                   const int around = std::max(3, root(std::sqrt(3.0) * std::numbers::pi * n / 2));
                   return make_cylinder(2.0, around, std::max(2, n / around));
                 },
                 [](int count) { return cylinder_eigenvalues(2.0, count); }},
    AnalyticKind{"ellipsoid", "Ellipsoid with semi-axes 1, 0.8, 0.6",
                 [](int n) { return make_ellipsoid(1.0, 0.8, 0.6, root((n - 2) / 10.0)); },
                 nullptr},
};

struct AnalyticArguments {
  int resolution = 2500;
  std::string format;
};

// --format, else the ending, else (for standard output) PLY.
MeshFormat format_for(const AnalyticArguments& args, const std::string& path) {
  if (!args.format.empty()) return mesh_formats().at(args.format);
  if (path == "-") return MeshFormat::ply;
  return mesh_format_of(path);
}

void make_analytic(const AnalyticKind& kind, const AnalyticArguments& args,
                   const Context& context) {
  const MeshFormat format = format_for(args, context.output);
  context.require_output();
  const TriangleMesh mesh = kind.make(args.resolution);
  context.write_result(context.output, to_mesh_bytes(mesh, format));
  constexpr int kEigenvalues = 50;
  const nlohmann::json known = kind.eigenvalues == nullptr
                                   ? nlohmann::json()
                                   : nlohmann::json(kind.eigenvalues(kEigenvalues));
  context.answer({{"file", context.output},
                  {"eigenvalues", known},
                  {"kind", kind.name},
                  {"vertices", mesh.vertices.rows()},
                  {"faces", mesh.faces.rows()}},
                 context.output == "-" ? "" : "wrote " + escape_control(context.output) + "\n");
}

void add_analytic(CLI::App& make, const AnalyticKind& kind, Context& context) {
  auto args = std::make_shared<AnalyticArguments>();
  CLI::App& command = *make.add_subcommand(kind.name, kind.about);
  command.add_option("--resolution", args->resolution, "about how many vertices")
      ->check(CLI::Range(12, 10000000))
      ->capture_default_str();
  command.add_option("--format", args->format, "ply, off or obj; default: the file's ending")
      ->check(CLI::IsMember({"ply", "off", "obj"}));
  add_common_options(command, context, true);
  command.get_option("--output")->required();
  command.footer(
      "--json has the lowest 50 eigenvalues where they are known in closed form (Neumann).\n"
      "Example:\n  timbre dataset make " +
      std::string(kind.name) + " -o " + std::string(kind.name) + ".ply --resolution 10000");
  command.callback([args, &kind, &context] { make_analytic(kind, *args, context); });
}

}  // namespace

void add_dataset(CLI::App& timbre, Context& context) {
  CLI::App& dataset = *timbre.add_subcommand("dataset", "Shapes to try things on");
  dataset.require_subcommand(1);
  add_dataset_info(dataset, context);
  CLI::App& make = *dataset.add_subcommand("make", "Makes shapes from nothing");
  make.require_subcommand(1);
  add_make_creatures(make, context);
  for (const AnalyticKind& kind : kAnalytic) add_analytic(make, kind, context);
}

}  // namespace timbre::cli
