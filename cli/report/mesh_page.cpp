#include "timbre/cli/report/mesh_page.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <utility>
#include <vector>

#include "timbre/analysis/core/number_text.h"
#include "timbre/analysis/mesh/diagnosis.h"
#include "timbre/cli/report/html.h"
#include "timbre/cli/report/mesh_findings.h"
#include "timbre/cli/report/page.h"

namespace timbre::cli {
namespace {

using Eigen::Index;
using Eigen::RowVector3d;

constexpr int kSide = 560;  // pixels

// Unlike for any colour vision (Okabe and Ito 2008), in the order of `Defect`.
Colour colour_of(Defect defect) {
  static const std::array<Colour, 8> kColours = {
      Colour(0.00F, 0.45F, 0.70F), Colour(0.84F, 0.37F, 0.00F), Colour(0.80F, 0.47F, 0.65F),
      Colour(0.90F, 0.62F, 0.00F), Colour(0.05F, 0.05F, 0.05F), Colour(0.00F, 0.62F, 0.45F),
      Colour(0.34F, 0.71F, 0.91F), Colour(0.94F, 0.89F, 0.26F)};
  return kColours[static_cast<std::size_t>(defect)];
}

// A mesh with marks on it: points in no triangle, with a ball each.
class MarkedMesh {
 public:
  // Edges are dotted; long ones have more dots.
  MarkedMesh(const TriangleMesh& mesh, double spacing) : mesh_(mesh), spacing_(spacing) {}

  void mark_edges(Defect defect, const std::vector<std::array<std::int32_t, 2>>& edges) {
    for (const auto& [from, to] : edges) {
      const RowVector3d a = mesh_.vertices.row(from);
      const RowVector3d b = mesh_.vertices.row(to);
      constexpr double kMost = 40.0;
      const double dots = spacing_ > 0.0 ? (b - a).stableNorm() / spacing_ : 1.0;
      const int steps = static_cast<int>(std::clamp(dots, 1.0, kMost));
      for (int i = 0; i < steps; ++i) add(defect, a + (b - a) * ((i + 0.5) / steps), kSmall);
    }
  }
  void mark_faces(Defect defect, const std::vector<std::int32_t>& faces) {
    for (const std::int32_t face : faces) {
      add(defect, mesh_.vertices(mesh_.faces.row(face), Eigen::all).colwise().mean(), kLarge);
    }
  }
  void mark_vertices(Defect defect, const std::vector<std::int32_t>& vertices) {
    for (const std::int32_t v : vertices) add(defect, mesh_.vertices.row(v), kMiddle);
  }

  [[nodiscard]] TriangleMesh mesh() const {
    TriangleMesh marked = mesh_;
    const auto count = static_cast<Index>(points_.size());
    marked.vertices.conservativeResize(mesh_.vertices.rows() + count, 3);
    for (Index i = 0; i < count; ++i) {
      marked.vertices.row(mesh_.vertices.rows() + i) = points_[static_cast<std::size_t>(i)];
    }
    return marked;
  }
  [[nodiscard]] const std::vector<Marker>& markers() const { return markers_; }

 private:
  static constexpr float kSmall = 0.008F;
  static constexpr float kMiddle = 0.014F;
  static constexpr float kLarge = 0.018F;

  void add(Defect defect, const RowVector3d& point, float radius) {
    const auto vertex = mesh_.vertices.rows() + static_cast<Index>(points_.size());
    markers_.push_back({static_cast<std::int32_t>(vertex), colour_of(defect), radius});
    points_.push_back(point);
  }

  const TriangleMesh& mesh_;
  double spacing_;
  std::vector<RowVector3d> points_;
  std::vector<Marker> markers_;
};

MarkedMesh mark(const TriangleMesh& mesh, const Diagnosis& found) {
  MarkedMesh marked(mesh, found.mean_edge / 8.0);
  marked.mark_edges(Defect::boundary, found.first_boundary_edges);
  marked.mark_edges(Defect::flipped_edge, found.first_flipped_edges);
  marked.mark_edges(Defect::nonmanifold_edge, found.first_nonmanifold_edges);
  marked.mark_vertices(Defect::coincident_vertex, found.first_coincident_vertices);
  marked.mark_vertices(Defect::nonmanifold_vertex, found.first_nonmanifold_vertices);
  marked.mark_faces(Defect::duplicate_face, found.first_duplicate_faces);
  marked.mark_faces(Defect::thin_face, found.first_thin_faces);
  marked.mark_faces(Defect::degenerate_face, found.first_degenerate_faces);
  return marked;
}

std::string pictures(const TriangleMesh& mesh, const Diagnosis& found, PictureMaker& maker) {
  const MarkedMesh marked = mark(mesh, found);
  const TriangleMesh with_marks = marked.mesh();
  const std::array<std::pair<const char*, View>, 4> views = {{{"from the front", {38.0, 20.0}},
                                                              {"from behind", {218.0, 20.0}},
                                                              {"from above", {38.0, 70.0}},
                                                              {"from below", {38.0, -50.0}}}};
  std::string cards;
  for (const auto& [words, view] : views) {
    const SurfaceLook look = {.mesh = with_marks, .markers = marked.markers()};
    const std::string alt = std::string("The mesh with its defects marked, ") + words;
    cards += figure("card", maker.picture({look, alt, view}, kSide), words);
  }
  return element("div", {{"class", "cards two"}}, cards);
}

std::string fact(const std::string& what, const std::string& value) {
  return element("div", element("dt", escape_html(what)) + element("dd", escape_html(value)));
}

std::string facts(const MeshFile& file, const Diagnosis& found) {
  std::string list = fact("format", file.format) +
                     fact("vertices, triangles",
                          std::to_string(found.vertices) + ", " + std::to_string(found.faces)) +
                     fact("surface", describe_surface(found));
  if (found.faces > 0) {
    list += fact("area", to_short_text(found.area, 6)) + fact("edges", describe_triangles(found));
  }
  if (found.volume) list += fact("volume", to_short_text(*found.volume, 6));
  return element("dl", {{"class", "facts"}}, list);
}

std::string finding_entry(const MeshFinding& finding) {
  std::string heading;
  if (finding.defect) {
    heading = element(
        "span",
        {{"class", "swatch"}, {"style", "background:" + to_hex(colour_of(*finding.defect))}}, "");
  }
  heading += escape_html(finding.what);
  if (finding.count > 0) heading += ": " + std::to_string(finding.count);
  std::string words = escape_html(finding.consequence);
  if (!finding.places.empty()) words += " (" + escape_html(finding.places) + ")";
  return element("div", element("dt", heading) + element("dd", words));
}

std::string oddities(const MeshFile& file, const Diagnosis& found) {
  std::string list;
  for (const MeshFinding& finding : findings_of(found)) list += finding_entry(finding);
  std::string content = list.empty() ? element("p", "Nothing is odd about this mesh.")
                                     : element("dl", {{"class", "facts"}}, list);
  std::string warnings;
  for (const ReadWarning& warning : file.warnings) {
    if (is_in_findings(warning)) continue;
    warnings += element("li", escape_html(warning.message));
  }
  if (!warnings.empty()) {
    content += element("h3", "What the reader met") + element("ul", warnings);
  }
  return content;
}

}  // namespace

std::string make_mesh_page(const std::string& name, const MeshFile& file, const Diagnosis& found,
                           const PictureOptions& options) {
  PictureMaker maker(options);
  const std::string title = std::filesystem::path(name).filename().string();
  const std::string content =
      element("header", element("h1", escape_html(title)) + "\n") + "<main>\n" +
      section("mesh", "What it is", facts(file, found)) +
      section("pictures", "What it looks like", pictures(file.mesh, found, maker)) +
      section("odd", "What is odd, and what that means for the spectrum", oddities(file, found)) +
      "</main>\n";
  return page(title, content, false);
}

}  // namespace timbre::cli
