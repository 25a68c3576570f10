#include "timbre/analysis/signatures/shape_dna.h"
#include "timbre/index/channel.h"

namespace timbre::detail {

// Low frequencies, levelled by Weyl's law: kinds of things.
Channel make_dna_i() {
  return {.name = "dna_i",
          .version = 1,
          .parameters = {{"count", "30"}, {"form", "per_index"}},
          .compute =
              [](const ShapeFeatures& features) {
                return compute_shape_dna(features.spectrum, ShapeDnaForm::per_index, 30);
              },
          .distance = euclidean_distance};
}

}  // namespace timbre::detail
