#include <cmath>

#include "timbre/analysis/signatures/shape_dna.h"
#include "timbre/index/channel.h"

namespace timbre::detail {

// Sees size: log eigenvalues at the mesh's own scale. The shift inside the logarithm
// is made at unit area, so that a change of the unit of length moves all entries alike.
Channel make_dna_raw() {
  return {.name = "dna_raw",
          .version = 1,
          .parameters = {{"count", "100"}, {"form", "logarithm"}, {"scale", "true"}},
          .compute = [](const ShapeFeatures& features) -> Eigen::VectorXd {
            return compute_shape_dna(features.spectrum, ShapeDnaForm::logarithm, 100).array() -
                   std::log(features.area);
          },
          .distance = mean_absolute_difference};
}

}  // namespace timbre::detail
