#include "timbre/matching/deformation.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <utility>

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;

// 3 x 3 matrices, one a vertex, flattened: a row each.
using MatrixField = Eigen::Matrix<double, Eigen::Dynamic, 9, Eigen::RowMajor>;
using RowMatrix3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

Points low_pass(const MatchSurface& s, const Points& values, Index size) {
  const MatrixXd phi = s.vectors.leftCols(std::min(size, s.vectors.cols()));
  return phi * (phi.transpose() * (s.mass.asDiagonal() * values));
}

// Sum over neighbours j of (to_j - to_i) (from_j - from_i)^T: its polar part is the
// rotation that best takes the neighbourhood in `from` to that in `to`.
MatrixField neighbourhood_correlations(const GeodesicGraph& graph, const Points& from,
                                       const Points& to) {
  MatrixField field(graph.size(), 9);
  for (Index i = 0; i < graph.size(); ++i) {
    RowMatrix3d sum = RowMatrix3d::Zero();
    for (std::int64_t e = graph.start[static_cast<std::size_t>(i)];
         e < graph.start[static_cast<std::size_t>(i) + 1]; ++e) {
      const std::int32_t j = graph.neighbour[static_cast<std::size_t>(e)];
      sum += (to.row(j) - to.row(i)).transpose() * (from.row(j) - from.row(i));
    }
    field.row(i) = Eigen::Map<const Eigen::RowVectorXd>(sum.data(), 9);
  }
  return field;
}

MatrixField averaged_over_neighbours(const GeodesicGraph& graph, const MatrixField& field) {
  MatrixField result(field.rows(), 9);
  for (Index i = 0; i < graph.size(); ++i) {
    Eigen::Matrix<double, 1, 9> sum = field.row(i);
    const std::int64_t begin = graph.start[static_cast<std::size_t>(i)];
    const std::int64_t end = graph.start[static_cast<std::size_t>(i) + 1];
    for (std::int64_t e = begin; e < end; ++e) {
      sum += field.row(graph.neighbour[static_cast<std::size_t>(e)]);
    }
    result.row(i) = sum / static_cast<double>(end - begin + 1);
  }
  return result;
}

Matrix3d nearest_isometry(const Matrix3d& M, int orientation) {
  const Eigen::JacobiSVD<Matrix3d> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3d U = svd.matrixU();
  const double determinant = (U * svd.matrixV().transpose()).determinant();
  if (determinant * orientation < 0.0) U.col(2) *= -1.0;
  return U * svd.matrixV().transpose();
}

}  // namespace

PosedSurface pose_as(const MatchSurface& A, const MatchSurface& B, const PointMap& ab, Index size,
                     int orientation) {
  const Points smooth = low_pass(A, A.points, size);
  PosedSurface posed{low_pass(A, B.points(ab, Eigen::all), size), Points(A.points.rows(), 3)};
  MatrixField field = neighbourhood_correlations(A.graph, smooth, posed.points);
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) field = averaged_over_neighbours(A.graph, field);
  for (Index i = 0; i < A.points.rows(); ++i) {
    const Matrix3d M = Eigen::Map<const RowMatrix3d>(&field(i, 0));
    const Matrix3d R = nearest_isometry(M, orientation);
    posed.points.row(i) += (R * (A.points.row(i) - smooth.row(i)).transpose()).transpose();
    posed.normals.row(i) = (R * A.normals.row(i).transpose()).transpose();
  }
  return posed;
}

double pose_residual(const MatchSurface& A, const MatchSurface& B, const PointMap& ab, Index size,
                     int orientation) {
  const Points posed = pose_as(A, B, ab, size, orientation).points;
  const Points image = B.points(ab, Eigen::all);
  return std::sqrt(A.mass.dot((posed - image).rowwise().squaredNorm()));
}

}  // namespace timbre
