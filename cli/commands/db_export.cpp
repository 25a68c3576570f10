#include <memory>
#include <string>

#include "timbre/analysis/mesh/write_mesh.h"
#include "timbre/cli/array_output.h"
#include "timbre/cli/commands/db.h"
#include "timbre/cli/options.h"
#include "timbre/index/store.h"

namespace timbre::cli {
namespace {

MeshFormat format_of(const std::string& path) {
  return path == "-" ? MeshFormat::ply : mesh_format_of(path);
}

struct Arguments {
  std::string database, name;
  bool spectrum = false;
};

void run(const Arguments& args, Context& context) {
  if (context.output.empty()) context.output = "-";
  const std::string& output = context.output;
  if (args.spectrum) {
    (void)array_format(output);
  } else {
    (void)format_of(output);
  }
  context.require_output();
  const Store store = Store::open(args.database);
  if (args.spectrum) {
    const auto shape = store.find(args.name);
    const Eigen::VectorXd values = store.eigenvalues(args.name) / shape.value_or(ShapeInfo()).area;
    context.write_result(output, to_file_bytes(output, {{"eigenvalues", values}}));
  } else {
    context.write_result(output, to_mesh_bytes(store.mesh(args.name), format_of(output)));
  }
  context.answer({{"name", args.name}, {"output", output}}, "");
}

}  // namespace

void add_db_export(CLI::App& db, Context& context) {
  auto args = std::make_shared<Arguments>();
  CLI::App& command = *db.add_subcommand("export", "Writes a stored mesh or its eigenvalues");
  command.add_option("DB", args->database, "the database")->required();
  command.add_option("NAME", args->name, "the shape")->required();
  command.add_flag("--spectrum", args->spectrum,
                   "the eigenvalues, at the mesh's own scale, as .npy, .npz, .mat or text");
  add_common_options(command, context, true);
  command.footer(
      "The mesh comes out bit for bit as it went in, as .off, .obj, .ply, .vtk or .asc. These\n"
      "round to float: .glb, .stl (which keeps no vertex numbers), and FreeSurfer's .white,\n"
      ".pial, .inflated, .sphere, .orig, .smoothwm and .surf.\n"
      "Example:\n  timbre db export shapes.timbre cat3 -o cat3.ply");
  command.callback([args, &context] { run(*args, context); });
}

}  // namespace timbre::cli
