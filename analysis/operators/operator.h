#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// Discrete Laplacians. All but the last four know the geometry; a letter is that of figure 18 in
/// the course "Spectral Mesh Processing" (its C, the cotangents divided by each row's own area, is
/// no symmetric matrix; its eigenpairs are those of `cotan`).
enum class OperatorKind : std::uint8_t {
  /// Cotangents of the intrinsic Delaunay triangulation of the tufted cover (Sharp and Crane
  /// 2020): weights are 0 or more on any triangle mesh. On a Delaunay manifold mesh that of
  /// `cotan`.
  robust,
  cotan,       ///< piecewise linear elements on the mesh as it is (Pinkall and Polthier 1993)
  p2,          ///< quadratic elements: also a node on each edge
  p3,          ///< cubic elements: two nodes on each edge, one in each triangle
  dec,         ///< E: discrete exterior calculus; circumcentric dual cells (Desbrun et al. 2005)
  graph,       ///< A: combinatorial, weight 1 on each edge
  tutte,       ///< the same, each row divided by its degree (Taubin 1995)
  unweighted,  ///< B: cotangents, all vertices alike
  averaged,    ///< D: cotangents over the mean area of an edge's ends (Levy 2006)
};

inline constexpr std::array kOperatorKinds = {
    OperatorKind::robust, OperatorKind::cotan,      OperatorKind::p2,
    OperatorKind::p3,     OperatorKind::dec,        OperatorKind::graph,
    OperatorKind::tutte,  OperatorKind::unweighted, OperatorKind::averaged};

enum class MassKind : std::uint8_t {
  lumped,         ///< diagonal: a third of the area around a vertex
  consistent,     ///< of the elements (Galerkin); eigenvalues come from above
  circumcentric,  ///< diagonal: mixed cells (Meyer et al. 2003); `dec`
  uniform,        ///< 1 (`graph`) or the component's mean vertex area (`unweighted`, `averaged`)
  degree,         ///< diagonal: number of edges at a vertex; `tutte`
};

inline constexpr std::array kMassKinds = {MassKind::lumped, MassKind::consistent,
                                          MassKind::circumcentric, MassKind::uniform,
                                          MassKind::degree};

/// What holds at edges of one triangle.
enum class BoundaryKind : std::uint8_t {
  neumann,    ///< nothing flows out
  dirichlet,  ///< functions are 0 there
};

struct OperatorOptions {
  OperatorKind kind = OperatorKind::robust;
  /// Lumped (the default) or consistent, of `robust` and `cotan`; others have one mass only.
  std::optional<MassKind> mass = {};
  BoundaryKind boundary = BoundaryKind::neumann;
  /// Least slack of the triangle inequality, in mean edge lengths. Lengths of a component
  /// with thinner triangles than this are all raised by the same small amount
  /// (mollification); others are left exactly as they are.
  double mollification = 1e-5;
};

/// The discrete eigenvalue problem `W phi = lambda M phi` of one mesh, at the mesh's own scale.
/// Row i belongs to vertex i; rows of `p2` and `p3` go on with the nodes that `number_nodes`
/// numbers. Rows that have no part in it (vertices in no triangle, in a component without area, or
/// on a Dirichlet boundary) are empty in both matrices.
struct Operator {
  SparseMatrix stiffness;  ///< W, N x N, symmetric positive semi-definite
  SparseMatrix mass;       ///< M, N x N, positive on rows that take part; length^2
  /// N; M itself where it is diagonal, else diagonal entries scaled to the same total (row sums of
  /// linear elements); 0 for rows that have no part.
  Eigen::VectorXd lumped_mass;
  Points
      positions;  ///< N x 3, or empty where they are not known; only the order of elimination asks
  std::vector<std::int32_t> component;  ///< N, connected component, -1 without part
  Eigen::VectorXd component_area;       ///< one per component, sum of its lumped mass
  std::vector<bool> has_constants;      ///< one per component: W has them in its kernel
  Eigen::Index vertices = 0;            ///< n, of the mesh
  double area = 0.0;  ///< 1' M 1, with the boundary: surface area; of `graph` the vertices, of
                      ///< `tutte` twice the edges
  double mollified_by = 0.0;    ///< most that was added to edge lengths; often 0
  std::int64_t flips = 0;       ///< intrinsic edge flips; `robust` only
  int components_left_out = 0;  ///< in which no face has area
  OperatorKind kind = OperatorKind::robust;
  MassKind mass_kind = MassKind::lumped;
  BoundaryKind boundary = BoundaryKind::neumann;
};

/// Assembles stiffness and mass.
///
/// Triangles with a repeated corner are left out, and components in which no triangle has
/// area. Only differences of positions count, divided by a power of two of each component's own:
/// neither a far origin nor an extreme or uneven unit of length costs digits.
///
/// @throws Error  bad_input for a corner that is no vertex or a coordinate that is not finite, if
///                no triangle has area, or a component has one beyond a double's range;
///                bad_request for negative mollification, a mass that the kind does not have, or a
///                Dirichlet boundary that holds all vertices
/// @see Levy and Zhang 2009, section 3
[[nodiscard]] Operator compute_operator(const TriangleMesh& mesh,
                                        const OperatorOptions& options = {});

/// The same from edge lengths alone, for surfaces that are not given in space. Where three or more
/// faces share an edge, `robust` takes them in the order of their third corners.
///
/// @param faces     m x 3, indices below `vertices`
/// @param lengths   m x 3, lengths(f, c) of the edge opposite corner c, neither far from
///                  1 nor smaller than 0
/// @param vertices  n
[[nodiscard]] Operator compute_operator(const Faces& faces, const Points& lengths,
                                        Eigen::Index vertices, const OperatorOptions& options = {});

/// The mass that these options mean.
/// @throws Error  bad_request if the kind does not have the one asked for
[[nodiscard]] MassKind mass_of(const OperatorOptions& options);

/// Number of zero eigenvalues: one for each component without a Dirichlet boundary.
[[nodiscard]] int count_zeros(const Operator& op);

/// `M^-1/2 W M^-1/2` of a diagonal mass, whose eigenvectors psi give phi = M^-1/2 psi: equation
/// 20 of the course. Rows without part stay empty.
/// @throws Error  bad_request if the mass is not diagonal
[[nodiscard]] SparseMatrix symmetrized(const Operator& op);

/// `cotan`, `lumped`, ...: the words of the command line and of stored parameters.
[[nodiscard]] const char* to_word(OperatorKind kind);
[[nodiscard]] const char* to_word(MassKind kind);
[[nodiscard]] const char* to_word(BoundaryKind kind);

}  // namespace timbre
