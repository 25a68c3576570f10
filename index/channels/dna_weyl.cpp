#include "timbre/analysis/signatures/shape_dna.h"
#include "timbre/index/channel.h"

namespace timbre::detail {

// All frequencies, levelled by Weyl's law: one individual in many poses.
Channel make_dna_weyl() {
  return {.name = "dna_weyl",
          .version = 1,
          .parameters = {{"count", "100"}, {"form", "weyl"}},
          .compute =
              [](const ShapeFeatures& features) {
                return compute_shape_dna(features.spectrum, ShapeDnaForm::weyl, 100);
              },
          .distance = mean_absolute_difference};
}

}  // namespace timbre::detail
