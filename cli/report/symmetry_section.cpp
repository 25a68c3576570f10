#include <algorithm>
#include <filesystem>
#include <system_error>

#include "timbre/analysis/core/number_text.h"
#include "timbre/analysis/mesh/sampling.h"
#include "timbre/cli/command.h"
#include "timbre/cli/render/transfer.h"
#include "timbre/cli/report/html.h"
#include "timbre/cli/report/material.h"
#include "timbre/datasets/truth.h"

namespace timbre::cli {
namespace {

constexpr std::size_t kMostShapes = 4;
constexpr int kSide = 360;   // pixels
constexpr int kSpread = 40;  // points among which those to mark are chosen
constexpr std::size_t kMarks = 4;

using VertexMap = std::vector<std::int32_t>;

std::string map_file(const Material& material, const EvaluatedMap& result) {
  return (std::filesystem::path(material.inputs.symmetry_maps) /
          (shape_stem(result.source) + ".txt"))
      .string();
}

// Colours that a point shares with its image: by where the middle of the two lies, and by how
// far they are apart.
VertexColours shared_colours(const TriangleMesh& mesh, const VertexMap& map, UpAxis up) {
  TriangleMesh halves = mesh;
  const Points points = mesh.vertices * rotation_to_y_up(up).transpose();
  halves.vertices = points;
  for (Eigen::Index v = 0; v < points.rows(); ++v) {
    const std::int32_t image = map[static_cast<std::size_t>(v)];
    if (image < 0) continue;
    const Eigen::RowVector3d middle = 0.5 * (points.row(v) + points.row(image));
    const Eigen::RowVector3d apart = points.row(v) - points.row(image);
    halves.vertices.row(v) << apart.norm(), middle.y(), middle.z();
  }
  return matched_colours(position_colours(halves, UpAxis::y), map);
}

// A few points far from their images and from each other; a point and its image have one colour.
std::vector<Marker> marked_pairs(const TriangleMesh& mesh, const VertexMap& map) {
  const auto count =
      static_cast<std::int32_t>(std::min<Eigen::Index>(kSpread, mesh.vertices.rows()));
  const double size =
      (mesh.vertices.colwise().maxCoeff() - mesh.vertices.colwise().minCoeff()).norm();
  const ColourTable colours = make_colour_table(ColourMapKind::categorical);
  const auto distance = [&](std::int32_t a, std::int32_t b) {
    return (mesh.vertices.row(a) - mesh.vertices.row(b)).norm();
  };
  std::vector<Marker> marks;
  for (const std::int32_t v : farthest_points(mesh.vertices, count)) {
    const std::int32_t image = map[static_cast<std::size_t>(v)];
    if (image < 0 || distance(v, image) < 0.12 * size || marks.size() == 2 * kMarks) continue;
    const bool is_new = std::all_of(marks.begin(), marks.end(), [&](const Marker& mark) {
      return std::min(distance(v, mark.vertex), distance(image, mark.vertex)) > 0.12 * size;
    });
    if (!is_new) continue;
    const Colour& colour = colours[marks.size() / 2];
    marks.push_back({v, colour});
    marks.push_back({image, colour});
  }
  return marks;
}

std::string shape_html(Material& material, const EvaluatedMap& result) {
  const TriangleMesh mesh = mesh_of(material, result.source);
  const std::string file = map_file(material, result);
  const VertexMap map = read_vertex_list(file, 0, mesh.vertices.rows());
  SurfaceLook look{.mesh = mesh};
  for_file(file, [&] {
    // Says what is wrong with a map of another length.
    (void)carry_colours(VertexColours::Zero(mesh.vertices.rows(), 3), map, mesh);
    look.colours = shared_colours(mesh, map, material.inputs.pictures.up);
  });
  look.markers = marked_pairs(mesh, map);
  const std::string name = shape_stem(result.source);
  std::string words =
      result.error ? "mean error " + to_text(*result.error, 2) : "no symmetry found";
  if (result.seconds) words += ", " + to_short_text(*result.seconds, 2) + " s";
  const std::string alt = "The shape " + name + "; points and their mirror images share colours";
  const std::string images =
      material.pictures.picture({look, alt + ", from its left", {-38.0, 20.0}}, kSide) +
      material.pictures.picture({look, alt + ", from its right", {38.0, 20.0}}, kSide);
  return figure("pair", element("div", images),
                element("b", escape_html(name)) + element("span", words));
}

}  // namespace

std::string symmetry_section(Material& material) {
  if (!material.symmetries || material.inputs.symmetry_maps.empty()) return "";
  std::string shapes;
  std::size_t count = 0;
  for (const EvaluatedMap& result : material.symmetries->maps) {
    if (count == kMostShapes) break;
    std::error_code failure;
    if (!std::filesystem::exists(map_file(material, result), failure)) continue;
    shapes += shape_html(material, result);
    ++count;
  }
  if (count == 0) return "";
  const std::string about =
      "Nobody tells the program which hand is the left one. It finds the map of a surface to "
      "itself that exchanges the sides; here each point has the colour of its mirror image, and "
      "balls of one colour mark a point and its image. Each shape is seen from two sides.";
  return section("symmetry", "Left and right",
                 element("p", about) + element("div", {{"class", "pairs"}}, shapes));
}

}  // namespace timbre::cli
