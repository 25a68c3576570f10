#include "timbre/analysis/spectrum/detail/block_kernels_body.h"

namespace timbre::detail {

const BlockKernels kAvx512BlockKernels = BlockProducts<8>::table();

}  // namespace timbre::detail
