#include "timbre/analysis/signatures/shape_dna.h"
#include "timbre/index/channel.h"

namespace timbre::detail {

// All frequencies, by ratio.
Channel make_dna_log() {
  return {.name = "dna_log",
          .version = 1,
          .parameters = {{"count", "100"}, {"form", "logarithm"}},
          .compute =
              [](const ShapeFeatures& features) {
                return compute_shape_dna(features.spectrum, ShapeDnaForm::logarithm, 100);
              },
          .distance = mean_absolute_difference};
}

}  // namespace timbre::detail
