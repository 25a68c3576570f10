#include "timbre/analysis/spectrum/detail/tile_kernels_body.h"

namespace timbre::detail {

const TileKernels kAvx512Kernels = Kernels<8>::table();

}  // namespace timbre::detail
