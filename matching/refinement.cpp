#include "timbre/matching/refinement.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <utility>

#include "timbre/analysis/core/threads.h"
#include "timbre/matching/deformation.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Ref;
using Eigen::VectorXd;

// Small enough that a block of distances to 10,000 points stays in the cache's reach.
constexpr Index kBlock = 128;
// Fixed, so that the order of the reduction over chunks is too.
constexpr Index kChunks = 16;

using RowVectorXf = Eigen::RowVectorXf;

RowVectorXf squared_norms(const RowMatrixXf& X) { return X.rowwise().squaredNorm().transpose(); }

std::int32_t smallest_entry(const float* values, Index count) {
  float least = values[0];
  for (Index j = 1; j < count; ++j) least = std::min(least, values[j]);
  return static_cast<std::int32_t>(std::find(values, values + count, least) - values);
}

struct ColumnMinima {
  std::vector<float> value;
  std::vector<std::int32_t> row;
};

void lower(ColumnMinima& minima, const float* distances, float own_norm, std::int32_t row) {
  const std::size_t count = minima.value.size();
  float* const value = minima.value.data();
  std::int32_t* const best = minima.row.data();
  for (std::size_t j = 0; j < count; ++j) {
    const float d = distances[j] + own_norm;
    best[j] = d < value[j] ? row : best[j];
    value[j] = std::min(d, value[j]);
  }
}

// |y|^2 - 2 x.y for a block of rows x and all y.
void relative_distances(const RowMatrixXf& X, Index first, Index rows, const RowMatrixXf& Y,
                        const RowVectorXf& norms, RowMatrixXf& block) {
  product_a_bt(X, first, rows, Y, block);
  block *= -2.0F;
  block.rowwise() += norms;
}

std::span<const std::int32_t> neighbours(const GeodesicGraph& graph, Index v) {
  const auto begin = static_cast<std::size_t>(graph.start[static_cast<std::size_t>(v)]);
  const auto end = static_cast<std::size_t>(graph.start[static_cast<std::size_t>(v) + 1]);
  return std::span(graph.neighbour).subspan(begin, end - begin);
}

// Ascending, each once.
void collect_around(const GeodesicGraph& x_graph, const GeodesicGraph& y_graph, const PointMap& now,
                    Index x, std::vector<std::int32_t>& around) {
  around.clear();
  const auto add = [&](Index v) {
    const std::int32_t image = now[static_cast<std::size_t>(v)];
    around.push_back(image);
    const auto ring = neighbours(y_graph, image);
    around.insert(around.end(), ring.begin(), ring.end());
  };
  add(x);
  for (const std::int32_t v : neighbours(x_graph, x)) add(v);
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
}

std::int32_t nearest_among(const RowMatrixXf& X, Index x, const RowMatrixXf& Y,
                           const RowVectorXf& norms, const std::vector<std::int32_t>& among) {
  std::int32_t best = among.front();
  float least = std::numeric_limits<float>::infinity();
  for (const std::int32_t y : among) {
    const float distance = norms[y] - 2.0F * X.row(x).dot(Y.row(y));
    if (distance >= least) continue;
    least = distance;
    best = y;
  }
  return best;
}

int capped(int size, const MatchSurface& A, const MatchSurface& B) {
  return static_cast<int>(std::min<Index>(
      {size, A.vectors.cols(), B.vectors.cols(), A.distances.rows() / 2, B.distances.rows() / 2}));
}

int capped_by_spectrum(int size, const MatchSurface& A, const MatchSurface& B) {
  return static_cast<int>(std::min<Index>({size, A.vectors.cols(), B.vectors.cols()}));
}

std::vector<std::int32_t> first_samples(const MatchSurface& s, Index count) {
  count = std::min<Index>(count, static_cast<Index>(s.samples.size()));
  return {s.samples.begin(), s.samples.begin() + count};
}

RowMatrixXf rows_of(const RowMatrixXf& X, const std::vector<std::int32_t>& rows) {
  return X(rows, Eigen::all);
}

// Positions and normals of both shapes in both poses, twelve more columns. The squared
// metric of the spectral part is half the sum of its eigenvalues, so that sum is the
// unit of the weights.
void append_poses(const MatchSurface& A, const MatchSurface& B, const PointMaps& points,
                  const DenseStep& step, Index k, int orientation, JointEmbedding& joint) {
  const PosedSurface a = pose_as(A, B, points.ab, step.pose_size, orientation);
  const PosedSurface b = pose_as(B, A, points.ba, step.pose_size, orientation);
  const double metric = 0.5 * (A.values.head(k).sum() + B.values.head(k).sum());
  const double s = std::sqrt(step.positions * metric);
  const double g = std::sqrt(step.normals * metric);
  const auto append = [](RowMatrixXf& rows, std::initializer_list<Points> parts) {
    Index at = rows.cols();
    rows.conservativeResize(Eigen::NoChange, at + 3 * static_cast<Index>(parts.size()));
    for (const Points& part : parts) {
      rows.middleCols(at, 3) = part.cast<float>();
      at += 3;
    }
  };
  append(joint.a, {s * a.points, g * a.normals, s * A.points, g * A.normals});
  append(joint.b, {s * B.points, g * B.normals, s * b.points, g * b.normals});
}

}  // namespace

JointEmbedding joint_embedding(const Ref<const MatrixXd>& phi_a, const Ref<const MatrixXd>& phi_b,
                               const FunctionalMaps& maps) {
  const Index k = maps.ab.rows();
  JointEmbedding joint{RowMatrixXf(phi_a.rows(), 2 * k), RowMatrixXf(phi_b.rows(), 2 * k)};
  joint.a.leftCols(k) = phi_a.cast<float>();
  joint.a.rightCols(k) = product_a_bt(phi_a, maps.ba).cast<float>();
  joint.b.leftCols(k) = product_a_bt(phi_b, maps.ab).cast<float>();
  joint.b.rightCols(k) = phi_b.cast<float>();
  return joint;
}

PointMap nearest_rows(const RowMatrixXf& X, const RowMatrixXf& Y, int threads) {
  PointMap nearest(static_cast<std::size_t>(X.rows()));
  const RowVectorXf norms = squared_norms(Y);
  const Index blocks = (X.rows() + kBlock - 1) / kBlock;
  parallel_for(blocks, threads, [&](std::int64_t b) {
    const Index first = b * kBlock;
    const Index rows = std::min(kBlock, X.rows() - first);
    RowMatrixXf block;
    relative_distances(X, first, rows, Y, norms, block);
    for (Index i = 0; i < rows; ++i) {
      nearest[static_cast<std::size_t>(first + i)] = smallest_entry(&block(i, 0), Y.rows());
    }
  });
  return nearest;
}

PointMaps nearest_rows_both_ways(const RowMatrixXf& X, const RowMatrixXf& Y, int threads) {
  PointMaps maps;
  maps.ab.resize(static_cast<std::size_t>(X.rows()));
  const auto columns = static_cast<std::size_t>(Y.rows());
  const RowVectorXf x_norms = squared_norms(X);
  const RowVectorXf y_norms = squared_norms(Y);
  std::vector<ColumnMinima> minima(kChunks);
  parallel_for(kChunks, threads, [&](std::int64_t chunk) {
    ColumnMinima& own = minima[static_cast<std::size_t>(chunk)];
    own.value.assign(columns, std::numeric_limits<float>::infinity());
    own.row.assign(columns, 0);
    RowMatrixXf block;
    const Index end = X.rows() * (chunk + 1) / kChunks;
    for (Index first = X.rows() * chunk / kChunks; first < end; first += kBlock) {
      const Index rows = std::min(kBlock, end - first);
      relative_distances(X, first, rows, Y, y_norms, block);
      for (Index i = 0; i < rows; ++i) {
        const float* const row = &block(i, 0);
        maps.ab[static_cast<std::size_t>(first + i)] = smallest_entry(row, Y.rows());
        lower(own, row, x_norms[first + i], static_cast<std::int32_t>(first + i));
      }
    }
  });
  maps.ba = std::move(minima[0].row);
  std::vector<float>& value = minima[0].value;
  for (std::size_t chunk = 1; chunk < minima.size(); ++chunk) {
    for (std::size_t j = 0; j < columns; ++j) {
      if (minima[chunk].value[j] >= value[j]) continue;
      value[j] = minima[chunk].value[j];
      maps.ba[j] = minima[chunk].row[j];
    }
  }
  return maps;
}

PointMap nearest_rows_nearby(const RowMatrixXf& X, const GeodesicGraph& x_graph,
                             const RowMatrixXf& Y, const GeodesicGraph& y_graph, PointMap start,
                             int sweeps, int threads) {
  const RowVectorXf norms = squared_norms(Y);
  PointMap now = std::move(start);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    PointMap next(now.size());
    parallel_for((X.rows() + kBlock - 1) / kBlock, threads, [&](std::int64_t block) {
      std::vector<std::int32_t> around;
      const Index end = std::min(X.rows(), (block + 1) * kBlock);
      for (Index i = block * kBlock; i < end; ++i) {
        const auto at = static_cast<std::size_t>(i);
        collect_around(x_graph, y_graph, now, i, around);
        next[at] = nearest_among(X, i, Y, norms, around);
      }
    });
    const bool still = next == now;
    now = std::move(next);
    if (still) break;
  }
  return now;
}

MatrixXd fit_functional_map(const Ref<const MatrixXd>& phi, const Ref<const VectorXd>& weight,
                            const Ref<const MatrixXd>& F) {
  const MatrixXd weighted = weight.asDiagonal() * phi;
  MatrixXd normal = product_at_b(phi, weighted);
  constexpr double kRegularisation = 1e-6;
  normal.diagonal().array() += kRegularisation * normal.trace() / static_cast<double>(phi.cols());
  return normal.llt().solve(product_at_b(weighted, F));
}

SampledMaps zoom_out_on_samples(const MatchSurface& A, const MatchSurface& B, const MatrixXd& C,
                                std::span<const int> sizes) {
  const MatrixXd phi_a = A.vectors(first_samples(A, A.distances.rows()), Eigen::all);
  const MatrixXd phi_b = B.vectors(first_samples(B, B.distances.rows()), Eigen::all);
  SampledMaps result{{C, C.transpose()}, {}};
  FunctionalMaps& maps = result.functional;
  const auto update_points = [&] {
    const Index k = maps.ab.rows();
    const JointEmbedding joint = joint_embedding(phi_a.leftCols(k), phi_b.leftCols(k), maps);
    result.points = nearest_rows_both_ways(joint.a, joint.b, 1);
  };
  for (const int size : sizes) {
    const int k = std::max<int>(capped(size, A, B), 1);
    update_points();
    maps.ab = fit_functional_map(phi_a.leftCols(k), A.sample_mass,
                                 phi_b(result.points.ab, Eigen::seqN(0, k)));
    maps.ba = fit_functional_map(phi_b.leftCols(k), B.sample_mass,
                                 phi_a(result.points.ba, Eigen::seqN(0, k)));
  }
  update_points();
  return result;
}

FunctionalMaps zoom_out_to_vertices(const MatchSurface& A, const MatchSurface& B,
                                    FunctionalMaps maps, std::span<const int> sizes, int samples,
                                    int threads) {
  const std::vector<std::int32_t> sa = first_samples(A, samples);
  const std::vector<std::int32_t> sb = first_samples(B, samples);
  const VectorXd wa = VectorXd::Ones(static_cast<Index>(sa.size()));
  const VectorXd wb = VectorXd::Ones(static_cast<Index>(sb.size()));
  for (const int size : sizes) {
    const Index known = maps.ab.rows();
    const Index k = capped_by_spectrum(size, A, B);
    const JointEmbedding joint =
        joint_embedding(A.vectors.leftCols(known), B.vectors.leftCols(known), maps);
    const PointMap ab = nearest_rows(rows_of(joint.a, sa), joint.b, threads);
    const PointMap ba = nearest_rows(rows_of(joint.b, sb), joint.a, threads);
    const auto columns = Eigen::seqN(0, k);
    maps.ab = fit_functional_map(A.vectors(sa, columns), wa, B.vectors(ab, columns));
    maps.ba = fit_functional_map(B.vectors(sb, columns), wb, A.vectors(ba, columns));
  }
  return maps;
}

PointMap between_files(const MatchSurface& from, const MatchSurface& to, const PointMap& rows) {
  PointMap map(static_cast<std::size_t>(from.file_vertices), -1);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    map[static_cast<std::size_t>(from.vertex[i])] = to.vertex[static_cast<std::size_t>(rows[i])];
  }
  return map;
}

DenseMaps refine_densely(const MatchSurface& A, const MatchSurface& B, FunctionalMaps maps,
                         std::span<const DenseStep> steps, int orientation, int threads) {
  DenseMaps result{std::move(maps), {}};
  const auto embedding = [&] {
    const Index k = result.functional.ab.rows();
    return joint_embedding(A.vectors.leftCols(k), B.vectors.leftCols(k), result.functional);
  };
  {
    const JointEmbedding joint = embedding();
    result.points = nearest_rows_both_ways(joint.a, joint.b, threads);
  }
  for (const DenseStep& step : steps) {
    const Index k = capped_by_spectrum(step.size, A, B);
    const auto columns = Eigen::seqN(0, k);
    const MatrixXd weighted_a = A.mass.asDiagonal() * A.vectors.leftCols(k);
    const MatrixXd weighted_b = B.mass.asDiagonal() * B.vectors.leftCols(k);
    result.functional.ab = product_at_b(weighted_a, B.vectors(result.points.ab, columns));
    result.functional.ba = product_at_b(weighted_b, A.vectors(result.points.ba, columns));
    JointEmbedding joint = embedding();
    if (step.positions > 0.0) append_poses(A, B, result.points, step, k, orientation, joint);
    constexpr int kSweeps = 4;
    result.points.ab = nearest_rows_nearby(joint.a, A.graph, joint.b, B.graph,
                                           std::move(result.points.ab), kSweeps, threads);
    result.points.ba = nearest_rows_nearby(joint.b, B.graph, joint.a, A.graph,
                                           std::move(result.points.ba), kSweeps, threads);
  }
  return result;
}

}  // namespace timbre
