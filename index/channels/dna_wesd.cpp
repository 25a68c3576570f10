#include "timbre/analysis/signatures/shape_dna.h"
#include "timbre/index/channel.h"

namespace timbre::detail {

// Low frequencies rule, high ones fade: kinds of things.
Channel make_dna_wesd() {
  return {.name = "dna_wesd",
          .version = 1,
          .parameters = {{"count", "100"}, {"form", "weighted"}},
          .compute =
              [](const ShapeFeatures& features) {
                return compute_shape_dna(features.spectrum, ShapeDnaForm::weighted, 100);
              },
          .distance = mean_absolute_difference};
}

}  // namespace timbre::detail
