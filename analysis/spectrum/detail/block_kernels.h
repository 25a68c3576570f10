#pragma once

#include "timbre/analysis/spectrum/detail/tile_kernels.h"

namespace timbre::detail {

// Tall and narrow products, for vectors in blocks: n x width, row-major, width 8 or 16. A block
// is read as one stream; BLAS reaches a third of the speed on them.

/// Kernels for one instruction set. All sets give the same to rounding. `next` is never read: as
/// many rows there are fetched into the cache, for the kernel that is called next.
struct BlockKernels {
  /// H += V^T Z over some rows of two blocks. H is width x width, row-major.
  void (*add_products)(const double* V, const double* Z, int rows, int width, double* H,
                       const double* next);

  /// U -= V H over some rows of two blocks.
  void (*subtract_multiples)(const double* V, const double* H, int rows, int width, double* U,
                             const double* next);
};

/// @param set  one that the processor has
[[nodiscard]] const BlockKernels& block_kernels(InstructionSet set);

// One in each of the files compiled for an instruction set.
extern const BlockKernels kPortableBlockKernels;
extern const BlockKernels kAvx2BlockKernels;
extern const BlockKernels kAvx512BlockKernels;

}  // namespace timbre::detail
