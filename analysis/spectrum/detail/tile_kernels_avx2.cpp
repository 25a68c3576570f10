#include "timbre/analysis/spectrum/detail/tile_kernels_body.h"

namespace timbre::detail {

const TileKernels kAvx2Kernels = Kernels<4>::table();

}  // namespace timbre::detail
