#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstdint>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre {

using SparseMatrix = Eigen::SparseMatrix<double>;

enum class OperatorKind : std::uint8_t { cotan };
enum class MassKind : std::uint8_t { lumped, consistent };

struct OperatorOptions {
  OperatorKind kind = OperatorKind::cotan;
  /// Lumped is diagonal and what most papers use. Consistent is more accurate on
  /// meshes of unlike triangulation; its eigenvalues come from above.
  MassKind mass = MassKind::lumped;
  /// Least slack of the triangle inequality, in mean edge lengths. Lengths of a component
  /// with thinner triangles than this are all raised by the same small amount
  /// (mollification); others are left exactly as they are.
  double mollification = 1e-5;
};

/// The discrete Laplace-Beltrami operator `W phi = lambda M phi` of one mesh, at the
/// mesh's own scale. Rows of vertices in no triangle are empty in both matrices.
struct Operator {
  SparseMatrix stiffness;               ///< W, n x n, symmetric positive semi-definite
  SparseMatrix mass;                    ///< M, n x n, positive on used vertices, length^2
  Eigen::VectorXd lumped_mass;          ///< n, row sums of M; 0 for unused vertices
  std::vector<std::int32_t> component;  ///< n, connected component of a vertex, -1 if unused
  Eigen::VectorXd component_area;       ///< one per component, length^2
  double area = 0.0;                    ///< total, length^2
  double mollified_by = 0.0;            ///< most that was added to edge lengths; often 0
  OperatorKind kind = OperatorKind::cotan;
  MassKind mass_kind = MassKind::lumped;
};

/// Assembles stiffness and mass.
///
/// Triangles with a repeated corner are left out. Only differences of positions count,
/// divided by a power of two of each component's own: neither a far origin nor an extreme
/// or uneven unit of length costs digits.
///
/// @throws Error  bad_input for a corner that is no vertex or a coordinate that is not
///                finite, if a component has no area at all, or one beyond a double's
///                range; bad_request for negative mollification
/// @see Pinkall and Polthier 1993; Sharp and Crane 2020, section 4.5 (mollification)
[[nodiscard]] Operator compute_operator(const TriangleMesh& mesh,
                                        const OperatorOptions& options = {});

/// The same from edge lengths alone, for surfaces that are not given in space.
///
/// @param faces     m x 3, indices below `vertices`
/// @param lengths   m x 3, lengths(f, c) of the edge opposite corner c, neither far from
///                  1 nor smaller than 0
/// @param vertices  n
[[nodiscard]] Operator compute_operator(const Faces& faces, const Points& lengths,
                                        Eigen::Index vertices, const OperatorOptions& options = {});

/// `cotan`, `lumped`, ...: the words of the command line and of stored parameters.
[[nodiscard]] const char* to_word(OperatorKind kind);
[[nodiscard]] const char* to_word(MassKind kind);

}  // namespace timbre
