#include "timbre/analysis/spectrum/detail/row_pieces.h"

#include <algorithm>
#include <cstdint>

#include "timbre/analysis/core/threads.h"

namespace timbre::detail {
namespace {

constexpr int kPieces = 8;

int piece_begin(int size, int piece) {
  const std::int64_t chunks = (size + kRowChunk - 1) / kRowChunk;
  return static_cast<int>(
      std::min<std::int64_t>(size, chunks * piece / row_pieces(size) * kRowChunk));
}

}  // namespace

int row_pieces(int size) { return size < kPieces * 16 * kRowChunk ? 1 : kPieces; }

void for_each_piece(int size, int threads, const std::function<void(int, int, int)>& visit) {
  parallel_for(row_pieces(size), threads, [&](std::int64_t i) {
    const int piece = static_cast<int>(i);
    visit(piece, piece_begin(size, piece), piece_begin(size, piece + 1));
  });
}

}  // namespace timbre::detail
