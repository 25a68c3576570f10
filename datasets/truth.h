#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "timbre/datasets/shape_set.h"

namespace timbre {

/// What is known of a map: rows of a vertex of the source and its right image. A vertex may
/// stand in several rows.
struct Truth {
  std::vector<std::int32_t> source;
  std::vector<std::int32_t> target;
  /// The source is a part: a map is found that answers nine tenths of the rows; otherwise
  /// it must answer all.
  bool partial = false;
};

/// A list of vertices, one a line, as results and truth have them.
///
/// @param first     number of the first vertex: 0 or 1; what lies below `first` is none, -1
/// @param vertices  of the mesh that the list leads to; larger numbers are refused
/// @throws Error  io; bad_input with the line of what is no integer or no vertex
[[nodiscard]] std::vector<std::int32_t> read_vertex_list(const std::string& path,
                                                         std::int32_t first, std::int64_t vertices);

/// The truth of a map between two shapes of a set: through the template where both have a
/// `.vts` file (line i = vertex for point i of the template, from 1, 0 = none); else the
/// source's `.map` file (line v = vertex of the whole for vertex v of the part, from 0); else
/// equal numbers, unless one of the two alone has a `.vts`.
///
/// @param sources  vertices of the source; @param targets of the target
/// @throws Error  bad_input for lists that do not fit the meshes or each other, or if there
///                are none and the numbers of vertices differ
[[nodiscard]] Truth map_truth(const ShapeSet& set, const SetShape& source, std::int64_t sources,
                              const SetShape& target, std::int64_t targets);

/// The truth of the left-right symmetry of a shape: `.vts` and `.sym.vts` (the image of each
/// template point); or `.vts` and the set's symmetry.txt, whose first line names columns
/// (`all`, or labels) and whose line i has the template points opposite point i, from 1.
/// @throws Error  bad_input as above, or if no symmetry is known
[[nodiscard]] Truth symmetry_truth(const ShapeSet& set, const SetShape& shape,
                                   std::int64_t vertices);

/// The truth of the wrong side: every target replaced by its image under the target's symmetry;
/// rows whose image is unknown are left out.
/// @param vertices  of the target
[[nodiscard]] Truth mirrored(const Truth& truth, const Truth& symmetry, std::int64_t vertices);

/// A fixed random choice of `count` rows, in their order; all if there are not more.
[[nodiscard]] Truth sampled(const Truth& truth, std::size_t count);

/// How the truth of maps from a shape is given: "vts", "map" or "numbers".
[[nodiscard]] const char* truth_form(const ShapeSet& set, const SetShape& shape);

/// Whether a file says something about the symmetry of a shape.
[[nodiscard]] bool has_symmetry_truth(const ShapeSet& set, const SetShape& shape);

}  // namespace timbre
