#include "timbre/matching/classic/functional_map.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "timbre/analysis/core/number_text.h"
#include "timbre/analysis/core/progress.h"
#include "timbre/analysis/signatures/wave_kernel.h"
#include "timbre/matching/detail/stages.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr std::array kSteps = {DenseStep{.size = 100, .positions = 0.0, .normals = 0.0},
                               DenseStep{.size = 120, .positions = 0.0, .normals = 0.0},
                               DenseStep{.size = 150, .positions = 0.0, .normals = 0.0},
                               DenseStep{.size = 200, .positions = 0.0, .normals = 0.0}};

Spectrum spectrum_of(const MatchSurface& surface) {
  Spectrum spectrum;
  spectrum.values = surface.values;
  spectrum.vectors = surface.vectors;
  spectrum.zeros = 1;
  return spectrum;
}

// Coefficients of the descriptors, each of unit length.
MatrixXd coefficients(const MatchSurface& surface, const WaveKernelBands& bands, Index k) {
  const MatrixXd descriptors = compute_wave_kernel_signature(spectrum_of(surface), bands);
  MatrixXd result =
      surface.vectors.leftCols(k).transpose() * (surface.mass.asDiagonal() * descriptors);
  result.colwise().normalize();
  return result;
}

// The C with C d_from ~ d_to and C Lambda_from ~ Lambda_to C; its rows part.
MatrixXd fit(const MatrixXd& d_from, const Eigen::VectorXd& lambda_from, const MatrixXd& d_to,
             const Eigen::VectorXd& lambda_to, double laplacian) {
  const MatrixXd gram = d_from * d_from.transpose();
  const MatrixXd mixed = d_from * d_to.transpose();
  const double scale = std::max(lambda_from.maxCoeff(), lambda_to.maxCoeff());
  const double weight = laplacian * static_cast<double>(d_from.cols());
  MatrixXd C(lambda_to.size(), lambda_from.size());
  for (Index i = 0; i < C.rows(); ++i) {
    MatrixXd system = gram;
    system.diagonal().array() +=
        weight * ((lambda_from.array() - lambda_to[i]) / scale).square() + 1e-9 * weight;
    C.row(i) = system.ldlt().solve(mixed.col(i)).transpose();
  }
  return C;
}

}  // namespace

PointMap match_by_descriptors(const MatchSurface& A, const MatchSurface& B,
                              const DescriptorMapOptions& options) {
  detail::require_at_least("functions", options.functions, 3);
  detail::require_at_least("energies", options.energies, 2);
  if (!(options.laplacian >= 0.0) || !std::isfinite(options.laplacian)) {
    throw Error(ErrorKind::bad_request, "", "laplacian",
                "is " + to_text(options.laplacian) + "; a finite number >= 0 is needed");
  }
  const Index k =
      std::min({static_cast<Index>(options.functions), A.values.size(), B.values.size()});
  const WaveKernelBands bands = wave_kernel_bands(spectrum_of(A), {.energies = options.energies});
  const MatrixXd d_a = coefficients(A, bands, k);
  const MatrixXd d_b = coefficients(B, bands, k);
  FunctionalMaps maps;
  maps.ab = fit(d_b, B.values.head(k), d_a, A.values.head(k), options.laplacian);
  maps.ba = fit(d_a, A.values.head(k), d_b, B.values.head(k), options.laplacian);
  std::vector<int> sizes;
  for (const int size : detail::kSampleSizes) {
    if (size > k) sizes.push_back(size);
  }
  sizes.insert(sizes.end(), detail::kVertexSizes.begin(), detail::kVertexSizes.end());
  sizes.insert(sizes.begin(), static_cast<int>(k));
  ProgressReporter reporter(options.progress, "matching", 2);
  maps =
      zoom_out_to_vertices(A, B, std::move(maps), sizes, detail::kVertexSamples, options.threads);
  reporter.advance();
  const DenseMaps dense = refine_densely(A, B, std::move(maps), kSteps, 1, options.threads);
  reporter.advance();
  return between_files(A, B, dense.points.ab);
}

}  // namespace timbre
