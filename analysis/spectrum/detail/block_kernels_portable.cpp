#include "timbre/analysis/spectrum/detail/block_kernels_body.h"

namespace timbre::detail {

const BlockKernels kPortableBlockKernels = BlockProducts<2>::table();

}  // namespace timbre::detail
