#include "timbre/cli/report/viewer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/mesh/half_edge.h"
#include "timbre/cli/report/html.h"

namespace timbre::cli {
namespace {

using Eigen::Index;

// Larger meshes are thinned out, for the size of the page.
constexpr std::int32_t kMostVertices = 12000;

using FloatPoints = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

// A mesh that is as fine as a page can carry, and which of the vertices it has.
DecimatedMesh thinned(const TriangleMesh& mesh) {
  if (mesh.vertices.rows() > kMostVertices) return decimate(mesh, kMostVertices);
  DecimatedMesh whole{mesh, {}};
  for (std::int32_t v = 0; v < mesh.vertices.rows(); ++v) whole.original.push_back(v);
  return whole;
}

// Turned to y up, around the origin, in a ball of radius 1.
FloatPoints placed(const TriangleMesh& mesh, UpAxis up) {
  const Eigen::RowVector3d low = mesh.vertices.colwise().minCoeff();
  const Eigen::RowVector3d high = mesh.vertices.colwise().maxCoeff();
  const Points moved = mesh.vertices.rowwise() - (0.5 * low + 0.5 * high);
  const double radius = std::max(moved.rowwise().norm().maxCoeff(), 1e-300);
  return (moved / radius * rotation_to_y_up(up).transpose()).cast<float>();
}

// Little-endian on every machine that timbre's arrays are written on.
template <typename Array>
std::string data_of(const Array& array) {
  std::string bytes(static_cast<std::size_t>(array.size()) * sizeof(array.data()[0]), '\0');
  std::memcpy(bytes.data(), array.data(), bytes.size());
  return to_base64(bytes);
}

std::string block(const char* name, const std::string& data) {
  return element("script", {{"type", "text/plain"}, {"data-name", name}}, data) + "\n";
}

std::string colours_of(const ViewedSurface& surface, const std::vector<std::int32_t>& original) {
  std::string bytes;
  for (const std::int32_t v : original) {
    for (int c = 0; c < 3; ++c) {
      const float channel = surface.colours(v, c);
      const float shown = std::isnan(channel) ? 0.6F : std::clamp(channel, 0.0F, 1.0F);
      bytes += static_cast<char>(std::lround(255.0F * shown));
    }
  }
  return to_base64(bytes);
}

std::string surface_data(const ViewedSurface& surface, const DecimatedMesh& thin, UpAxis up,
                         const std::string& prefix) {
  const FloatPoints points = placed(surface.mesh, up);
  FloatPoints kept(static_cast<Index>(thin.original.size()), 3);
  for (Index i = 0; i < kept.rows(); ++i) {
    kept.row(i) = points.row(thin.original[static_cast<std::size_t>(i)]);
  }
  return block((prefix + "-points").c_str(), data_of(kept)) +
         block((prefix + "-faces").c_str(), data_of(thin.mesh.faces)) +
         block((prefix + "-colours").c_str(), colours_of(surface, thin.original));
}

// Where each source vertex that is shown goes: points of the target, which need not be
// vertices that are shown; NaN for none.
std::string images(const ViewedSurface& target, const std::vector<std::int32_t>& original,
                   const std::vector<std::int32_t>& map, UpAxis up) {
  const FloatPoints points = placed(target.mesh, up);
  FloatPoints images(static_cast<Index>(original.size()), 3);
  for (Index i = 0; i < images.rows(); ++i) {
    const std::int32_t v = map[static_cast<std::size_t>(original[static_cast<std::size_t>(i)])];
    if (v < 0) {
      images.row(i).setConstant(std::nanf(""));
    } else {
      images.row(i) = points.row(v);
    }
  }
  return data_of(images);
}

std::string button(const char* action, const char* words) {
  return element("button", {{"type", "button"}, {"data-action", action}}, words);
}

}  // namespace

std::string viewer(const ViewedSurface& source, const ViewedSurface& target,
                   const std::vector<std::int32_t>& map, UpAxis up, const std::string& fallback) {
  std::optional<DecimatedMesh> from, to;
  try {
    from = thinned(source.mesh);
    to = thinned(target.mesh);
  } catch (const Error&) {
    // Not a manifold, and too fine to be carried whole: the pictures stay.
    return fallback;
  }
  const std::string about = "The surfaces " + source.name + " and " + target.name +
                            " in matching colours; arrow keys turn them, plus and minus zoom";
  std::string html = element("div", {{"class", "still"}}, fallback);
  html += element("canvas", {{"tabindex", "0"}, {"role", "img"}, {"aria-label", about}}, "");
  html += element(
      "div", {{"class", "controls"}},
      button("closer", "Closer") + button("farther", "Farther") + button("reset", "Reset view"));
  html +=
      "\n" + surface_data(source, *from, up, "source") + surface_data(target, *to, up, "target");
  html += block("images", images(target, from->original, map, up));
  return element("div", {{"class", "viewer"}, {"data-state", "still"}}, html) +
         element("p", {{"class", "hint"}},
                 "Drag to turn both, or use the arrow keys; point at one surface and the matched "
                 "point is marked on the other.") +
         element("noscript", element("p", "With JavaScript these pictures can be turned.")) + "\n";
}

}  // namespace timbre::cli
