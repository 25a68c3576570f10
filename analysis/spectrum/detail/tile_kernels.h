#pragma once

#include <cstdint>

namespace timbre::detail {

// The dense work of factorisation and solves, on tiles: 8 rows of a matrix, column after column.
// A padded tile has 8 values for each column, at tile[8 k + i], zeros below the matrix, and is
// aligned to 64 bytes. The factor itself is stored in compact tiles: the last one has only as
// many rows as there are. So all of it is read as one stream, forward and backward.

inline constexpr int kTile = 8;         ///< rows of a tile
inline constexpr int kPanelWidth = 64;  ///< most columns of a panel
inline constexpr int kMaxChunk = 32;    ///< most right-hand sides in one pass

[[nodiscard]] constexpr int padded(int size) { return (size + kTile - 1) / kTile * kTile; }

/// Columns of the factor that share a diagonal block, as the solves read them:
/// P A11 P^T = L11 D L11^T, with the rows L21 below.
struct Panel {
  const double* inverse;  ///< of L11, compact tiles; tile t has the columns 0 ... 8 t + 7
  const double* below;    ///< L21, compact tiles of `rest` rows, then of `listed` rows
  const int* order;       ///< width: row i of P x is row order[i] of x
  const double* d;        ///< width: diagonal of D^-1
  const double* e;        ///< width: D^-1(k + 1, k), 0 between blocks
  int column;             ///< the first one
  int width;
  int rest;         ///< rows that follow the panel's own without a gap
  int listed;       ///< rows in `rows`
  const int* rows;  ///< ascending
};

/// The processor's instructions that a set of kernels uses.
enum class InstructionSet : std::uint8_t { portable, avx2, avx512 };

/// Kernels for one instruction set. All sets give the same to rounding.
struct TileKernels {
  /// C -= A B^T for `count` padded tiles of A, below each other in C, and one of B; both have
  /// `depth` columns, tiles lie `stride` apart. C is column-major, aligned to 64 bytes.
  void (*subtract_products)(const double* A, int count, int stride, const double* B, int depth,
                            double* C, std::int64_t ld);

  /// B = A X^T for `count` padded tiles and a lower triangular X of `width` rows, in padded
  /// tiles; tiles of A, X and B lie 8 padded(width) apart.
  void (*multiply_by_transpose)(const double* A, int count, const double* X, int width, double* B);

  /// Eliminates column k of a lower triangle of padded(width) columns of that length:
  /// A(k+1.., k+1..) -= a a^T / pivot for a = A(k+1.., k), which becomes a / pivot.
  void (*eliminate_one)(double* A, int width, int k, double inverse_pivot);

  /// The same for columns k and k + 1, with the inverse of the 2 x 2 pivot: its diagonal
  /// d[0], d[1] and e beside it.
  void (*eliminate_two)(double* A, int width, int k, const double* d, double e);

  /// X = L^-1 for a unit lower triangle L, whose diagonal and upper half are stored as zeros;
  /// both have padded(width) columns of that length.
  void (*invert)(const double* L, int width, double* X);

  /// X := L^-1 X for the panel's columns, and its share subtracted below. Rows of X begin `stride`
  /// apart, at most kMaxChunk, and have 8, 16 or 32 columns, or `least_columns`.
  void (*forward)(const Panel& panel, double* X, int stride, int columns);

  /// X := L^-T D^-1 X for the panel's columns; the rows below are final.
  void (*backward)(const Panel& panel, double* X, int stride, int columns);

  int least_columns;  ///< 4 or 8
};

/// Whether this processor, and this build, can run such kernels.
[[nodiscard]] bool has(InstructionSet set);

/// The fastest that this processor can run.
[[nodiscard]] InstructionSet best_instruction_set();

/// @param set  one that the processor has
[[nodiscard]] const TileKernels& tile_kernels(InstructionSet set);

// One in each of the files compiled for an instruction set.
extern const TileKernels kPortableKernels;
extern const TileKernels kAvx2Kernels;
extern const TileKernels kAvx512Kernels;

}  // namespace timbre::detail
