#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "timbre/matching/surface.h"

namespace timbre {

using PointMap = std::vector<std::int32_t>;

/// Functional maps both ways, of one size.
struct FunctionalMaps {
  Eigen::MatrixXd ab;  ///< F(B) -> F(A): coefficients of f o T_AB
  Eigen::MatrixXd ba;  ///< F(A) -> F(B)
};

struct PointMaps {
  PointMap ab;  ///< a point of B for each point of A
  PointMap ba;
};

/// Both shapes in one space of 2 k dimensions, in which nearness means agreement with
/// both functional maps at once; the base of joint (bijective) ZoomOut.
struct JointEmbedding {
  RowMatrixXf a;  ///< rows of A: [Phi_A, Phi_A C_BA^T]
  RowMatrixXf b;  ///< rows of B: [Phi_B C_AB^T, Phi_B]
};

[[nodiscard]] JointEmbedding joint_embedding(const Eigen::Ref<const Eigen::MatrixXd>& phi_a,
                                             const Eigen::Ref<const Eigen::MatrixXd>& phi_b,
                                             const FunctionalMaps& maps);

/// The nearest row of Y for each row of X; ties to the smaller index.
[[nodiscard]] PointMap nearest_rows(const RowMatrixXf& X, const RowMatrixXf& Y, int threads);

/// Both directions from one pass over the distances.
[[nodiscard]] PointMaps nearest_rows_both_ways(const RowMatrixXf& X, const RowMatrixXf& Y,
                                               int threads);

/// The nearest row of Y among those around the present images: of a row x, the images of
/// x and its neighbours, and their neighbours on the target. Sweeps until nothing moves,
/// at most `sweeps` times. Finds what an exact search finds where a map is nearly right
/// already, at a cost that is linear in the number of rows.
[[nodiscard]] PointMap nearest_rows_nearby(const RowMatrixXf& X, const GeodesicGraph& x_graph,
                                           const RowMatrixXf& Y, const GeodesicGraph& y_graph,
                                           PointMap start, int sweeps, int threads);

/// C with `Phi C ~ F` in the weighted least-squares sense; a little regularised.
[[nodiscard]] Eigen::MatrixXd fit_functional_map(const Eigen::Ref<const Eigen::MatrixXd>& phi,
                                                 const Eigen::Ref<const Eigen::VectorXd>& weight,
                                                 const Eigen::Ref<const Eigen::MatrixXd>& F);

/// A map between rows of two surfaces as one between the vertices of their files; -1 for
/// vertices that a surface leaves out.
[[nodiscard]] PointMap between_files(const MatchSurface& from, const MatchSurface& to,
                                     const PointMap& rows);

struct SampledMaps {
  FunctionalMaps functional;
  PointMaps points;  ///< between sample numbers, not vertices
};

/// Joint ZoomOut between the geodesic samples of both shapes: point maps from functional
/// maps and back, at each of the growing `sizes`.
/// @see Melzi et al. 2019 (ZoomOut); Ren et al. 2020 (bijective)
[[nodiscard]] SampledMaps zoom_out_on_samples(const MatchSurface& A, const MatchSurface& B,
                                              const Eigen::MatrixXd& C, std::span<const int> sizes);

/// The same with the first `samples` samples of each shape against all vertices of the other.
[[nodiscard]] FunctionalMaps zoom_out_to_vertices(const MatchSurface& A, const MatchSurface& B,
                                                  FunctionalMaps maps, std::span<const int> sizes,
                                                  int samples, int threads);

struct DenseMaps {
  FunctionalMaps functional;
  PointMaps points;  ///< between rows of the surfaces
};

/// One step of dense refinement: its spectral size, and how much each shape posed as the
/// other counts beside the spectral embedding.
struct DenseStep {
  int size = 100;
  double positions = 2.0;  ///< 1: as much as the spectral part; 0: not at all
  double normals = 0.005;  ///< the same; large values tear the map
  int pose_size = 40;      ///< eigenfunctions of the smooth part of the pose
};

/// All vertices on both sides: at each step functional maps from the point maps, each shape
/// posed as the other, and new point maps from nearness in spectrum and in space together.
/// Space decides where the spectrum slides, on torsos and thighs.
/// @param orientation  +1 direct, -1 mirrored
/// @see Eisenberger et al. 2020 (Smooth Shells) for the idea of both at once
[[nodiscard]] DenseMaps refine_densely(const MatchSurface& A, const MatchSurface& B,
                                       FunctionalMaps maps, std::span<const DenseStep> steps,
                                       int orientation, int threads);

}  // namespace timbre
