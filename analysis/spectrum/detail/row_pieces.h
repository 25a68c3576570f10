#pragma once

#include <functional>

namespace timbre::detail {

inline constexpr int kRowChunk = 64;  ///< pieces are whole chunks, but for the last

/// How many pieces rows are worked on in: the same for any number of threads. Few rows are one.
[[nodiscard]] int row_pieces(int size);

/// Calls `visit(piece, begin, end)` for all pieces of the rows [0, size), on several threads;
/// 0: all cores.
void for_each_piece(int size, int threads, const std::function<void(int, int, int)>& visit);

}  // namespace timbre::detail
