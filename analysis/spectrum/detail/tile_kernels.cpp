#include "timbre/analysis/spectrum/detail/tile_kernels.h"

namespace timbre::detail {

bool has([[maybe_unused]] InstructionSet set) {
#ifdef TIMBRE_X86_KERNELS
  if (set == InstructionSet::avx2) {
    return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
  }
  if (set == InstructionSet::avx512) return __builtin_cpu_supports("avx512f") != 0;
#endif
  return set == InstructionSet::portable;
}

InstructionSet best_instruction_set() {
  static const InstructionSet best = [] {
    if (has(InstructionSet::avx512)) return InstructionSet::avx512;
    return has(InstructionSet::avx2) ? InstructionSet::avx2 : InstructionSet::portable;
  }();
  return best;
}

const TileKernels& tile_kernels([[maybe_unused]] InstructionSet set) {
#ifdef TIMBRE_X86_KERNELS
  if (set == InstructionSet::avx512) return kAvx512Kernels;
  if (set == InstructionSet::avx2) return kAvx2Kernels;
#endif
  return kPortableKernels;
}

}  // namespace timbre::detail
