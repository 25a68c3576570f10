#include "timbre/cli/report/mesh_findings.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "timbre/analysis/core/number_text.h"

namespace timbre::cli {
namespace {

constexpr std::size_t kListed = 5;

std::string to_place(std::int32_t number) { return std::to_string(number); }

std::string to_place(const std::array<std::int32_t, 2>& edge) {
  return std::to_string(edge[0]) + "-" + std::to_string(edge[1]);
}

template <typename Place>
std::string list(const std::vector<Place>& first, std::int64_t count) {
  const std::size_t shown = std::min(kListed, first.size());
  std::string text;
  for (std::size_t i = 0; i < shown; ++i) text += (i == 0 ? "" : ", ") + to_place(first[i]);
  return static_cast<std::int64_t>(shown) < count ? text + ", ..." : text;
}

// What coordinates and sizes cost.
void add_about_sizes(const Diagnosis& found, std::vector<MeshFinding>& findings) {
  constexpr double kUneven = 1e4;
  constexpr double kFewDigits = 8.0;
  if (found.shortest_edge > 0.0 && found.longest_edge / found.shortest_edge > kUneven) {
    findings.push_back({"edge lengths differ by a factor of " +
                            to_short_text(found.longest_edge / found.shortest_edge, 2),
                        0, "",
                        "eigenvalues keep fewer digits, and eigenfunctions no detail where edges "
                        "are long"});
  }
  if (found.faces > 0 && found.digits < kFewDigits) {
    findings.push_back({"far from the origin", 0, "",
                        "coordinates hold about " + to_short_text(std::floor(found.digits), 2) +
                            " digits of an edge's length; no operator can know more"});
  }
}

}  // namespace

std::vector<MeshFinding> findings_of(const Diagnosis& found) {
  std::vector<MeshFinding> findings;
  const auto add = [&findings](std::int64_t count, const char* what, const std::string& places,
                               const char* consequence, std::optional<Defect> defect = {}) {
    if (count > 0) findings.push_back({what, count, places, consequence, defect});
  };
  add(found.components > 1 ? found.components : 0, "components", "",
      "one eigenvalue 0 for each, and every eigenfunction lives on one of them");
  add(found.boundary_loops, "boundary loops", "",
      "the natural (Neumann) condition holds there; --boundary dirichlet sets functions to 0",
      Defect::boundary);
  add(found.nonmanifold_edges, "edges of three or more triangles",
      list(found.first_nonmanifold_edges, found.nonmanifold_edges),
      "heat flows through all sheets; 'robust' joins them as they lie around the edge",
      Defect::nonmanifold_edge);
  add(found.nonmanifold_vertices, "non-manifold vertices",
      list(found.first_nonmanifold_vertices, found.nonmanifold_vertices),
      "the sheets are joined at a point only, which low frequencies hardly feel",
      Defect::nonmanifold_vertex);
  add(found.flipped_edges, "edges whose two triangles are turned unlike",
      list(found.first_flipped_edges, found.flipped_edges),
      "no effect on the spectrum; normals and volume suffer", Defect::flipped_edge);
  add(found.degenerate_faces, "triangles without area",
      list(found.first_degenerate_faces, found.degenerate_faces),
      "edge lengths are raised a little (mollified) to keep the weights finite",
      Defect::degenerate_face);
  add(found.thin_faces, "triangles with an angle below 1 degree",
      list(found.first_thin_faces, found.thin_faces),
      "plain cotangents are inaccurate there; 'robust' flips edges intrinsically first",
      Defect::thin_face);
  add(found.duplicate_faces, "triangles there already",
      list(found.first_duplicate_faces, found.duplicate_faces),
      "their area counts twice, which lowers eigenvalues nearby", Defect::duplicate_face);
  add(found.coincident_vertices, "vertices at the place of an earlier one",
      list(found.first_coincident_vertices, found.coincident_vertices),
      "they stay apart: a seam along them is a slit, open like a boundary, until you weld them",
      Defect::coincident_vertex);
  add(found.unused_vertices, "vertices in no triangle",
      list(found.first_unused_vertices, found.unused_vertices),
      "they keep their number, eigenfunctions are 0 there");
  add_about_sizes(found, findings);
  return findings;
}

bool is_in_findings(const ReadWarning& warning) {
  return warning.code == "duplicate-face" || warning.code == "unused-vertex" ||
         warning.code == "coincident-vertex";
}

std::string describe_surface(const Diagnosis& found) {
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

std::string describe_triangles(const Diagnosis& found) {
  return to_short_text(found.shortest_edge, 3) + " to " + to_short_text(found.longest_edge, 3) +
         ", mean " + to_short_text(found.mean_edge, 3) + "; smallest angle " +
         to_short_text(found.smallest_angle, 2) + " degrees";
}

std::string counted(std::int64_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

}  // namespace timbre::cli
