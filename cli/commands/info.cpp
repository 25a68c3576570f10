#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"
#include "timbre/analysis/core/output_file.h"
#include "timbre/analysis/mesh/diagnosis.h"
#include "timbre/analysis/mesh/read_mesh.h"
#include "timbre/cli/command.h"
#include "timbre/cli/options.h"
#include "timbre/cli/report/mesh_findings.h"
#include "timbre/cli/report/mesh_page.h"

namespace timbre::cli {
namespace {

using nlohmann::json;

template <typename Value>
json or_null(const std::optional<Value>& value) {
  return value ? json(*value) : json();
}

// JSON knows no infinity.
json or_null(double value) { return std::isfinite(value) ? json(value) : json(); }

json edges_to_json(const Diagnosis& found) {
  return {{"shortest", or_null(found.shortest_edge)},
          {"mean", or_null(found.mean_edge)},
          {"longest", or_null(found.longest_edge)},
          {"digits", found.digits}};
}

json to_json(const std::string& path, const MeshFile& file, const Diagnosis& found) {
  json warnings = json::array();
  for (const ReadWarning& warning : file.warnings) {
    warnings.push_back(
        {{"code", warning.code}, {"count", warning.count}, {"message", warning.message}});
  }
  return {{"mesh", path},
          {"format", file.format},
          {"vertices", found.vertices},
          {"faces", found.faces},
          {"components", found.components},
          {"boundary_loops", found.boundary_loops},
          {"boundary_edges", found.boundary_edges},
          {"genus", or_null(found.genus)},
          {"manifold", found.manifold},
          {"orientable", found.orientable},
          {"flipped_edges", found.flipped_edges},
          {"nonmanifold_edges", found.nonmanifold_edges},
          {"nonmanifold_vertices", found.nonmanifold_vertices},
          {"degenerate_faces", found.degenerate_faces},
          {"duplicate_faces", found.duplicate_faces},
          {"thin_faces", found.thin_faces},
          {"coincident_vertices", found.coincident_vertices},
          {"unused_vertices", found.unused_vertices},
          {"smallest_angle", found.smallest_angle},
          {"edges", edges_to_json(found)},
          {"area", or_null(found.area)},
          {"volume", found.volume ? or_null(*found.volume) : json()},
          {"warnings", std::move(warnings)}};
}

std::string to_line(const MeshFinding& finding) {
  std::string line = finding.what;
  if (finding.count > 0) line += ": " + std::to_string(finding.count);
  if (!finding.places.empty()) line += " (" + finding.places + ")";
  return line + "; " + finding.consequence;
}

std::string to_text(const std::string& path, const MeshFile& file, const Diagnosis& found) {
  std::string text = escape_control(path) + ": " + file.format + ", " +
                     counted(found.vertices, "vertex", "vertices") + ", " +
                     counted(found.faces, "triangle", "triangles") + "\n";
  text += "surface: " + describe_surface(found) + "\n";
  if (found.faces > 0) {
    text += "area: " + to_short_text(found.area, 6) + "\n";
    text += "edges: " + describe_triangles(found) + "\n";
  }
  if (found.volume) text += "volume: " + to_short_text(*found.volume, 6) + "\n";
  for (const MeshFinding& finding : findings_of(found)) text += "- " + to_line(finding) + "\n";
  for (const ReadWarning& warning : file.warnings) {
    if (is_in_findings(warning)) continue;
    text += "- file: " + escape_control(warning.message) + "\n";
  }
  return text;
}

// What `--report` needs beside the mesh.
struct PageRequest {
  std::string output;
  PictureOptions pictures;
};

void write_page(const Context& context, const std::string& path, const MeshFile& file,
                const Diagnosis& found, PageRequest request) {
  request.pictures.threads = context.threads;
  request.pictures.progress = context.progress();
  context.write_result(request.output, make_mesh_page(path, file, found, request.pictures));
}

}  // namespace

void add_info(CLI::App& app, Context& context) {
  auto mesh = std::make_shared<std::string>();
  auto page = std::make_shared<PageRequest>();
  CLI::App& command =
      *app.add_subcommand("info", "What a mesh is, what is odd about it, and what that means");
  command
      .add_option("MESH", *mesh,
                  "OFF, OBJ, PLY, STL, FreeSurfer, VTK or GLB file, also .gz; - for stdin")
      ->required();
  CLI::Option* const report = command.add_option(
      "--report", page->output, "also write a page with pictures on which each defect is marked");
  add_up_option(command, page->pictures.up);
  command.get_option("--up")->needs(report);
  add_read_options(command, context);
  add_threads_option(command, context);
  command.get_option("--threads")->needs(report);
  add_common_options(command, context, false);
  command.add_flag("--force", context.force, "let the page replace an existing file")
      ->needs(report);
  command.footer(
      "Examples:\n  timbre info horse.ply --json | jq .genus\n"
      "  timbre info scan.ply --report scan.html");

  command.callback([mesh, page, &context] {
    if (page->output == "-") {
      throw Error(ErrorKind::bad_request, "", "report",
                  "standard output holds the answer; name a file");
    }
    if (!page->output.empty()) require_writable(page->output, context.force);
    const MeshFile file = read_mesh_file(context, *mesh);
    constexpr std::size_t kMarked = 4000;  // of each kind; more would hide the shape
    const Diagnosis found =
        page->output.empty() ? diagnose(file.mesh) : diagnose(file.mesh, kMarked);
    if (!page->output.empty()) write_page(context, *mesh, file, found, *page);
    context.answer(to_json(*mesh, file, found), to_text(*mesh, file, found));
  });
}

}  // namespace timbre::cli
