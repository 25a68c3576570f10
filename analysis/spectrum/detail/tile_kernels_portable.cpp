#include "timbre/analysis/spectrum/detail/tile_kernels_body.h"

namespace timbre::detail {

const TileKernels kPortableKernels = Kernels<2>::table();

}  // namespace timbre::detail
