#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"
#include "timbre/analysis/mesh/diagnosis.h"
#include "timbre/analysis/mesh/read_mesh.h"
#include "timbre/cli/command.h"

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

std::string list(const std::vector<std::int32_t>& first, std::int64_t count) {
  std::string text;
  for (const std::int32_t i : first) text += (text.empty() ? "" : ", ") + std::to_string(i);
  return static_cast<std::int64_t>(first.size()) < count ? text + ", ..." : text;
}

std::string list(const std::vector<std::array<std::int32_t, 2>>& first, std::int64_t count) {
  std::string text;
  for (const auto& [from, to] : first) {
    text += (text.empty() ? "" : ", ") + std::to_string(from) + "-" + std::to_string(to);
  }
  return static_cast<std::int64_t>(first.size()) < count ? text + ", ..." : text;
}

std::string counted(std::int64_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

std::string surface(const Diagnosis& found) {
  if (found.faces == 0) return "none: points only; there is no spectrum to compute";
  std::string text = counted(found.components, "component", "components");
  text += found.boundary_edges == 0
              ? ", closed"
              : ", " + counted(found.boundary_loops, "boundary loop", "boundary loops");
  text += found.manifold ? ", manifold" : ", not manifold";
  text += found.orientable ? ", orientable" : ", not orientable";
  if (found.genus) {
    text += ", " + (found.orientable ? "genus " + std::to_string(*found.genus)
                                     : counted(*found.genus, "cross-cap", "cross-caps"));
  }
  return text;
}

// What coordinates and sizes cost.
void add_about_sizes(const Diagnosis& found, std::vector<std::string>& lines) {
  constexpr double kUneven = 1e4;
  constexpr double kFewDigits = 8.0;
  if (found.shortest_edge > 0.0 && found.longest_edge / found.shortest_edge > kUneven) {
    lines.push_back("edge lengths differ by a factor of " +
                    to_short_text(found.longest_edge / found.shortest_edge, 2) +
                    "; eigenvalues keep fewer digits, and eigenfunctions no detail where edges "
                    "are long");
  }
  if (found.faces > 0 && found.digits < kFewDigits) {
    lines.push_back("far from the origin: coordinates hold about " +
                    to_short_text(std::floor(found.digits), 2) +
                    " digits of an edge's length; no operator can know more");
  }
}

// What was found, where, and what it means for the spectrum.
std::vector<std::string> findings(const Diagnosis& found) {
  std::vector<std::string> lines;
  const auto add = [&lines](std::int64_t count, const char* what, const std::string& where,
                            const char* consequence) {
    if (count == 0) return;
    std::string line = std::string(what) + ": " + std::to_string(count);
    if (!where.empty()) line += " (" + where + ")";
    lines.push_back(line + "; " + consequence);
  };
  add(found.components > 1 ? found.components : 0, "components", "",
      "one eigenvalue 0 for each, and every eigenfunction lives on one of them");
  add(found.boundary_loops, "boundary loops", "", "the natural (Neumann) condition holds there");
  add(found.nonmanifold_edges, "edges of three or more triangles",
      list(found.first_nonmanifold_edges, found.nonmanifold_edges),
      "heat flows through all sheets; 'robust' joins them as they lie around the edge");
  add(found.nonmanifold_vertices, "non-manifold vertices",
      list(found.first_nonmanifold_vertices, found.nonmanifold_vertices),
      "the sheets are joined at a point only, which low frequencies hardly feel");
  add(found.flipped_edges, "edges whose two triangles are turned unlike",
      list(found.first_flipped_edges, found.flipped_edges),
      "no effect on the spectrum; normals and volume suffer");
  add(found.degenerate_faces, "triangles without area",
      list(found.first_degenerate_faces, found.degenerate_faces),
      "edge lengths are raised a little (mollified) to keep the weights finite");
  add(found.thin_faces, "triangles with an angle below 1 degree",
      list(found.first_thin_faces, found.thin_faces),
      "plain cotangents are inaccurate there; 'robust' flips edges intrinsically first");
  add(found.duplicate_faces, "triangles there already",
      list(found.first_duplicate_faces, found.duplicate_faces),
      "their area counts twice, which lowers eigenvalues nearby");
  add(found.coincident_vertices, "vertices at the place of an earlier one",
      list(found.first_coincident_vertices, found.coincident_vertices),
      "they stay apart: a seam along them is a slit, open like a boundary, until you weld them");
  add(found.unused_vertices, "vertices in no triangle",
      list(found.first_unused_vertices, found.unused_vertices),
      "they keep their number, eigenfunctions are 0 there");
  add_about_sizes(found, lines);
  return lines;
}

// The diagnosis says the same, with its consequence.
bool is_in_findings(const ReadWarning& warning) {
  return warning.code == "duplicate-face" || warning.code == "unused-vertex" ||
         warning.code == "coincident-vertex";
}

std::string to_text(const std::string& path, const MeshFile& file, const Diagnosis& found) {
  std::string text = escape_control(path) + ": " + file.format + ", " +
                     counted(found.vertices, "vertex", "vertices") + ", " +
                     counted(found.faces, "triangle", "triangles") + "\n";
  text += "surface: " + surface(found) + "\n";
  if (found.faces > 0) {
    text += "area: " + to_short_text(found.area, 6) + "\n";
    text += "edges: " + to_short_text(found.shortest_edge, 3) + " to " +
            to_short_text(found.longest_edge, 3) + ", mean " + to_short_text(found.mean_edge, 3) +
            "; smallest angle " + to_short_text(found.smallest_angle, 2) + " degrees\n";
  }
  if (found.volume) text += "volume: " + to_short_text(*found.volume, 6) + "\n";
  for (const std::string& line : findings(found)) text += "- " + line + "\n";
  for (const ReadWarning& warning : file.warnings) {
    if (is_in_findings(warning)) continue;
    text += "- file: " + escape_control(warning.message) + "\n";
  }
  return text;
}

}  // namespace

void add_info(CLI::App& app, Context& context) {
  auto mesh = std::make_shared<std::string>();
  CLI::App& command =
      *app.add_subcommand("info", "What a mesh is, what is odd about it, and what that means");
  command
      .add_option("MESH", *mesh,
                  "OFF, OBJ, PLY, STL, FreeSurfer or VTK file, also .gz; - for stdin")
      ->required();
  add_read_options(command, context);
  add_common_options(command, context, false);
  command.footer("Example:\n  timbre info horse.ply --json | jq .genus");

  command.callback([mesh, &context] {
    const MeshFile file = read_mesh_file(context, *mesh);
    const Diagnosis found = diagnose(file.mesh);
    context.answer(to_json(*mesh, file, found), to_text(*mesh, file, found));
  });
}

}  // namespace timbre::cli
