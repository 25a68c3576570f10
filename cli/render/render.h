#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "timbre/analysis/core/progress.h"
#include "timbre/analysis/mesh/triangle_mesh.h"
#include "timbre/cli/render/camera.h"
#include "timbre/cli/render/colour_map.h"
#include "timbre/cli/render/image.h"

namespace timbre::cli {

/// A colour for each vertex, as a place in a table. Places are interpolated, not colours: a
/// large triangle shows the colours between its corners.
struct ColourField {
  Eigen::VectorXd places;  ///< n, in [0, 1]; NaN: no colour, drawn grey
  ColourTable table;       ///< at least one colour, sRGB
  bool nearest = false;    ///< each point takes its nearest corner's place: for labels
};

/// Lines along which a function takes given values, of the same width everywhere.
struct Isolines {
  Eigen::VectorXd values;  ///< n
  std::vector<double> levels;
};

/// A ball on a vertex.
struct Marker {
  std::int32_t vertex = 0;
  Colour colour;          ///< sRGB
  float radius = 0.028F;  ///< in units of half the mesh's largest extent
};

using VertexColours = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// A surface and what is shown on it; by default plain clay.
struct SurfaceLook {
  const TriangleMesh& mesh;
  VertexColours colours = {};             ///< n x 3, sRGB, or empty; NaN: no colour, drawn grey
  std::optional<ColourField> field = {};  ///< instead of `colours`
  std::optional<Isolines> lines = {};
  std::vector<Marker> markers = {};
};

struct RenderOptions {
  int width = 512;   ///< pixels of each picture, at least 1
  int height = 512;  ///< pixels of each picture, at least 1
  UpAxis up = UpAxis::y;
  std::optional<Colour> background = {};  ///< sRGB; none: transparent
  int threads = 0;                        ///< 0: all cores
  Progress progress = {};                 ///< may be empty
};

/// Draws a surface as seen from each of the views, all at one scale, so large that it fills
/// the picture that needs most room.
///
/// Soft light from above the viewer's left shoulder; what lies in folds is darker
/// (ambient occlusion by rays chosen without chance). The side that faces inward is
/// darker and cooler. The result does not depend on the number of threads, nor, up to
/// rounding, on the mesh's scale and origin.
///
/// @throws Error  bad_input if no triangle has an area; bad_request if sizes do not agree
///                or a marker is no vertex; cancelled
[[nodiscard]] std::vector<Image> render(const SurfaceLook& look, const std::vector<View>& views,
                                        const RenderOptions& options = {});

}  // namespace timbre::cli
