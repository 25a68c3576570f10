#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre {

/// Neighbourhoods on a manifold mesh. Vertices keep their numbers.
class HalfEdgeMesh {
 public:
  /// @throws Error  bad_input, with the edge, vertex or face, if an edge has three triangles
  ///                or two turned unlike, the triangles of a vertex form more than one fan,
  ///                or a triangle repeats a corner
  explicit HalfEdgeMesh(const TriangleMesh& mesh);
  ~HalfEdgeMesh();
  HalfEdgeMesh(HalfEdgeMesh&&) noexcept;
  HalfEdgeMesh& operator=(HalfEdgeMesh&&) noexcept;

  /// The vertices of each boundary loop, in order, the surface on the left. A loop starts at
  /// its smallest vertex; loops are sorted by it.
  [[nodiscard]] std::vector<std::vector<std::int32_t>> boundary_loops() const;

  /// The neighbours of a vertex, counter-clockwise seen from outside. On the boundary the
  /// first and the last are the two boundary neighbours. Empty for an unused vertex.
  [[nodiscard]] std::vector<std::int32_t> one_ring(std::int32_t vertex) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

struct DecimatedMesh {
  TriangleMesh mesh;
  std::vector<std::int32_t> original;  ///< for each vertex its number in the mesh before; ascending
};

/// A coarser mesh on some of the vertices, chosen by quadric error; the topology stays.
/// Unused vertices are left out. Stops above `target` where every further collapse would
/// change the topology or turn a triangle over.
///
/// @param target  vertices wanted, at least 4
/// @throws Error  bad_input as HalfEdgeMesh does; bad_request if `target` is below 4
/// @see Garland and Heckbert 1997
[[nodiscard]] DecimatedMesh decimate(const TriangleMesh& mesh, std::int32_t target);

}  // namespace timbre
