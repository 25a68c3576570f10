#include "timbre/analysis/spectrum/detail/block_kernels.h"

namespace timbre::detail {

const BlockKernels& block_kernels([[maybe_unused]] InstructionSet set) {
#ifdef TIMBRE_X86_KERNELS
  if (set == InstructionSet::avx512) return kAvx512BlockKernels;
  if (set == InstructionSet::avx2) return kAvx2BlockKernels;
#endif
  return kPortableBlockKernels;
}

}  // namespace timbre::detail
