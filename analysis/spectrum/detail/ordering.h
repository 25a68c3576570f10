#pragma once

#include <cstdint>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"
#include "timbre/analysis/spectrum/detail/pencil.h"

namespace timbre::detail {

/// Adjacency of a symmetric pattern, without its diagonal.
struct Graph {
  std::vector<int> start;       ///< size + 1
  std::vector<int> neighbours;  ///< of vertex v: [start[v], start[v + 1]), ascending

  [[nodiscard]] int size() const { return static_cast<int>(start.size()) - 1; }
};

/// @throws Error  bad_request for more than 2^31 - 1 adjacencies
[[nodiscard]] Graph adjacency(const Pencil& pencil);

/// How the unknowns are ordered before factorising. Fill and speed depend on it, results do not.
enum class OrderingMethod : std::uint8_t {
  automatic,  ///< geometric where there are positions, else METIS; minimum degree if small
  geometric,  ///< nested dissection by planes: a fifth of the time of METIS, 1.2 to 1.7 times the
              ///< fill
  metis,      ///< nested dissection by METIS: best when hundreds of vectors are solved
  minimum_degree,  ///< approximate minimum degree of Eigen: best below some thousand unknowns
  natural,         ///< as given
};

/// Whether timbre was built with METIS.
[[nodiscard]] bool has_metis();

/// A fill-reducing permutation: unknown `order[i]` is eliminated as number i. Deterministic.
///
/// @param positions  n x 3, or nullptr if unknown; any unit of length
/// @throws Error  bad_request for `geometric` without positions, or positions of another size or
///                not finite; for `metis` in a build without it
[[nodiscard]] std::vector<int> compute_ordering(const Graph& graph, const Points* positions,
                                                OrderingMethod method);

/// Nested dissection by planes (George 1973, with the vertex positions as in Gilbert, Miller and
/// Teng 1998, but straight cuts): each part is cut across its principal axis where the fewest
/// edges cross, between 30 and 70 % of it; the smaller side of the cut edges is the separator and
/// comes last. Works for every graph; fills little where edges are short.
///
/// @param positions  n x 3, finite
[[nodiscard]] std::vector<int> geometric_dissection(const Graph& graph, const Points& positions);

}  // namespace timbre::detail
