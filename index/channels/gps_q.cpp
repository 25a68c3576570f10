#include "timbre/analysis/embedding/embedding.h"
#include "timbre/analysis/signatures/distance_quantiles.h"
#include "timbre/index/channel.h"

namespace timbre::detail {

// Distances in the GPS embedding. The mean absolute difference of two quantile
// functions is the Wasserstein-1 distance of the two distributions.
Channel make_gps_q() {
  return {
      .name = "gps_q",
      .version = 1,
      .parameters = {{"dimensions", "25"}, {"quantiles", "64"}, {"samples", "500"}},
      .compute = [](const ShapeFeatures& features) -> Eigen::VectorXd {
        // More components than eigenvalues: nothing to embed by.
        if (features.spectrum.zeros == features.spectrum.values.size()) return {};
        const Eigen::MatrixXd gps =
            compute_embedding(features.spectrum, {.kind = EmbeddingKind::gps, .dimensions = 25});
        return compute_distance_quantiles(gps, features.masses, {.samples = 500, .quantiles = 64});
      },
      .distance = mean_absolute_difference};
}

}  // namespace timbre::detail
