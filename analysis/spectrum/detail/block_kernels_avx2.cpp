#include "timbre/analysis/spectrum/detail/block_kernels_body.h"

namespace timbre::detail {

const BlockKernels kAvx2BlockKernels = BlockProducts<4>::table();

}  // namespace timbre::detail
