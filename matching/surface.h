#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "timbre/analysis/core/matrix_product.h"
#include "timbre/analysis/core/progress.h"
#include "timbre/analysis/geodesic/graph.h"
#include "timbre/analysis/mesh/orientation.h"
#include "timbre/analysis/mesh/triangle_mesh.h"
#include "timbre/analysis/spectrum/spectrum.h"

namespace timbre {

/// A third-order tensor over low eigenfunctions, one matrix per first index.
using Tensor3 = std::vector<Eigen::MatrixXd>;

/// What matching needs of one shape: computed once, used for any number of pairs.
/// All of it is at unit area and of the largest connected component only; `vertex`
/// leads back to the file.
struct MatchSurface {
  std::vector<std::int32_t> vertex;  ///< n, file index of each row, ascending
  Eigen::Index file_vertices = 0;
  double component_share = 1.0;  ///< area of this component in the whole mesh
  double area = 1.0;             ///< of this component at the scale of the file

  Points points;         ///< n x 3, centred
  Faces faces;           ///< rows of `points`
  Points normals;        ///< n x 3, unit, area-weighted
  Eigen::VectorXd mass;  ///< n, lumped, sums to 1
  GeodesicGraph graph;   ///< edges and unfolded diagonals
  Orientation orientation = Orientation::none;

  Eigen::VectorXd values;   ///< k eigenvalues, values(0) = 0
  Eigen::MatrixXd vectors;  ///< n x k

  /// Farthest points, nested: any prefix is a good sample. The first
  /// `distances.rows()` are geodesic, the rest Euclidean.
  std::vector<std::int32_t> samples;
  RowMatrixXf distances;        ///< geodesic from a sample to every vertex
  Eigen::VectorXd sample_mass;  ///< mass of the nearest-sample cells of those samples

  Eigen::VectorXd curvature;  ///< k coefficients of the mean curvature, unit norm
  Tensor3 products;           ///< P_ijk = integral of phi_i phi_j phi_k, without the constant
  Tensor3 areas;              ///< O_ijk = integral of phi_k dphi_i ^ dphi_j, without the constant
};

struct SurfaceOptions {
  int eigenpairs = 200;        ///< at least 8; fewer on meshes with fewer vertices
  int samples = 1000;          ///< points for the finer stages; at least 30
  int geodesic_samples = 400;  ///< of these with a row of distances; at least 30
  int tensor_size = 20;        ///< functions the search may use, the constant not; at least 3
  int threads = 0;             ///< 0: all cores; the result does not depend on it
  Progress progress = {};
};

/// Spectrum, samples, geodesic distances, curvature and tensors of one mesh.
///
/// @throws Error  bad_input if the largest component has fewer than 30 vertices;
///                bad_request for options below their least values;
///                whatever `compute_operator` and `compute_spectrum` throw
/// @see Ren et al. 2018 (orientation by dphi_i ^ dphi_j); Huang and Ovsjanikov 2017,
///      Nogneng and Ovsjanikov 2017 (maps preserve products)
[[nodiscard]] MatchSurface prepare_surface(const TriangleMesh& mesh,
                                           const SurfaceOptions& options = {});

/// The same with eigenpairs that are known already.
///
/// @param mesh      one component, every vertex in use
/// @param spectrum  of its cotangent Laplacian with lumped mass, at the mesh's scale; signs
///                  and rotations within near-equal eigenvalues are free
/// @throws Error  bad_request if mesh and spectrum do not fit together
[[nodiscard]] MatchSurface prepare_surface(const TriangleMesh& mesh, Spectrum spectrum,
                                           const SurfaceOptions& options = {});

}  // namespace timbre
