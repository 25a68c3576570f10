#include "timbre/analysis/spectrum/detail/front.h"

#include <algorithm>
#include <cstring>

// NOLINTBEGIN(bugprone-implicit-widening-of-multiplication-result): tiles of one front
namespace timbre::detail {
namespace {

constexpr std::size_t kBlock = static_cast<std::size_t>(kPanelWidth) * kPanelWidth;

// Largest sizes over all fronts.
struct Largest {
  std::int64_t front = 0;  // values of its columns
  std::int64_t below = 0;  // values of padded rows below a panel
};

Largest largest(const SymbolicFactor& symbolic) {
  Largest most;
  for (int s = 0; s < symbolic.supernodes(); ++s) {
    const std::int64_t columns = padded(symbolic.columns(s));
    const std::int64_t rows = columns + padded(symbolic.rows_below(s));
    most.front = std::max(most.front, rows * columns);
    most.below = std::max(most.below, rows * std::min<std::int64_t>(columns, kPanelWidth));
  }
  return most;
}

// Of constant size: no call.
void copy_tile_column(const double* from, double* to) {
  std::memcpy(to, from, kTile * sizeof(double));
}

// A triangle of whole tiles, without those above the diagonal: compact, as the solves read it.
double* store_inverse(const double* tiles, int width, double* to) {
  for (int row = 0; row < width; row += kTile, tiles += kTile * padded(width)) {
    const int height = std::min(kTile, width - row);
    for (int k = 0; k < row + height; ++k, to += height) {
      std::copy_n(tiles + kTile * k, height, to);
    }
  }
  return to;
}

double* store_tiles(const double* tiles, int stride, int rows, int width, double* to) {
  for (int row = 0; row < rows; row += kTile, tiles += stride) {
    const int height = std::min(kTile, rows - row);
    if (height == kTile) {
      to = std::copy_n(tiles, kTile * width, to);
      continue;
    }
    for (int k = 0; k < width; ++k, to += height) std::copy_n(tiles + kTile * k, height, to);
  }
  return to;
}

}  // namespace

FrontFactorizer::FrontFactorizer(const SymbolicFactor& symbolic)
    : block_(kBlock), work_(kBlock), inverse_(kBlock) {
  const Largest most = largest(symbolic);
  front_ = AlignedArray(static_cast<std::size_t>(most.front));
  lower_ = AlignedArray(static_cast<std::size_t>(most.below));
  product_ = AlignedArray(static_cast<std::size_t>(most.below));
}

std::int64_t FrontFactorizer::workspace_bytes(const SymbolicFactor& symbolic) {
  const Largest most = largest(symbolic);
  return static_cast<std::int64_t>(sizeof(double)) *
         (most.front + 2 * most.below + 3 * static_cast<std::int64_t>(kBlock));
}

void FrontFactorizer::factorize(const FactorInput& input, int s, std::span<const Child> children,
                                double* update, const FactorArrays& out) {
  const SymbolicFactor& symbolic = input.symbolic;
  assemble(input, s);
  const std::int64_t side = padded(rows_);
  for (std::int64_t j = 0; j < side; ++j) {  // on and below the diagonal tiles
    const std::int64_t first = j / kTile * kTile;
    std::fill_n(update + j * side + first, side - first, 0.0);
  }
  for (const Child& child : children) add_child(symbolic, child, update);
  out.counts[s] = {};
  for (int p = input.layout.first_panel[s]; p < input.layout.first_panel[s + 1]; ++p) {
    FactorArrays own = out;
    own.counts = out.counts + s;
    factorize_panel(input, input.layout.panels[p], update, own);
  }
}

void FrontFactorizer::assemble(const FactorInput& input, int s) {
  first_ = input.symbolic.first_column[s];
  columns_ = input.symbolic.columns(s);
  rows_ = input.symbolic.rows_below(s);
  ld_ = padded(columns_) + padded(rows_);
  std::fill_n(front_.data(), ld_ * padded(columns_), 0.0);
  const Pencil& pencil = input.pencil;
  for (int j = 0; j < columns_; ++j) {
    double* column = front_.data() + j * ld_;
    for (std::int64_t e = pencil.start[first_ + j]; e < pencil.start[first_ + j + 1]; ++e) {
      column[input.entry_row[e]] = pencil.k[e] - input.shift * pencil.m[e];
    }
  }
}

// Its rows ascend in this front too: first those among its columns, then those below.
void FrontFactorizer::add_child(const SymbolicFactor& symbolic, const Child& child,
                                double* update) {
  const int rows = symbolic.rows_below(child.supernode);
  const int* place = symbolic.place.data() + symbolic.first_row[child.supernode];
  const double* from = child.update;
  const std::int64_t side = padded(rows);
  const int in_columns = static_cast<int>(std::lower_bound(place, place + rows, columns_) - place);
  const int gap = padded(columns_) - columns_;
  for (int j = 0; j < in_columns; ++j, from += side) {
    double* to = front_.data() + place[j] * ld_;
    for (int i = j; i < in_columns; ++i) to[place[i]] += from[i];
    to += gap;
    for (int i = in_columns; i < rows; ++i) to[place[i]] += from[i];
  }
  const std::int64_t own_side = padded(rows_);
  for (int j = in_columns; j < rows; ++j, from += side) {
    double* to = update + (place[j] - columns_) * own_side - columns_;
    for (int i = j; i < rows; ++i) to[place[i]] += from[i];
  }
}

void FrontFactorizer::factorize_panel(const FactorInput& input, const PanelPlace& panel,
                                      double* update, const FactorArrays& out) {
  begin_ = panel.column - first_;
  width_ = panel.width;
  rest_ = columns_ - begin_ - width_;
  rest_tiles_ = padded(rest_) / kTile;
  tiles_ = rest_tiles_ + padded(rows_) / kTile;
  stride_ = kTile * padded(width_);
  const int side = padded(width_);
  std::fill_n(block_.data(), side * side, 0.0);
  for (int k = 0; k < width_; ++k) {
    std::copy_n(front_.data() + (begin_ + k) * ld_ + begin_, width_, block_.data() + k * side);
  }
  const DiagonalBlock factor{out.order + panel.column, out.d + panel.column, out.e + panel.column,
                             inverse_.data()};
  out.counts->add(factorize_block(input.kernels, block_.data(), width_,
                                  input.scale.data() + panel.column, work_.data(), factor));
  if (tiles_ > 0) {
    load_below(panel, factor.order);
    input.kernels.multiply_by_transpose(lower_.data(), tiles_, inverse_.data(), width_,
                                        product_.data());
    divide_by_pivots(factor.d, factor.e);
    subtract_from_rest(input.kernels, update);
  }
  store(out.values + panel.values);
}

// Rows below the panel, its columns permuted, into padded tiles.
void FrontFactorizer::load_below(const PanelPlace& panel, const int* order) {
  double* to = lower_.data();
  for (int t = 0; t < tiles_; ++t) {
    const int row = t < rest_tiles_ ? begin_ + panel.width + kTile * t
                                    : padded(columns_) + kTile * (t - rest_tiles_);
    for (int k = 0; k < width_; ++k, to += kTile) {
      copy_tile_column(front_.data() + (begin_ + order[k]) * ld_ + row, to);
    }
    to += stride_ - kTile * width_;
  }
}

// L21 = (L21 D) D^-1.
void FrontFactorizer::divide_by_pivots(const double* d, const double* e) {
  for (int t = 0; t < tiles_; ++t) {
    const double* from = product_.data() + static_cast<std::int64_t>(t) * stride_;
    double* to = lower_.data() + static_cast<std::int64_t>(t) * stride_;
    for (int k = 0; k < width_; ++k) {
      for (int i = 0; i < kTile; ++i) to[kTile * k + i] = from[kTile * k + i] * d[k];
    }
    for (int k = 0; k + 1 < width_; ++k) {
      if (e[k] == 0.0) continue;
      for (int i = kTile * k; i < kTile * (k + 1); ++i) {
        to[i] += from[i + kTile] * e[k];
        to[i + kTile] += from[i] * e[k];
      }
    }
  }
}

// The front's later columns, and what it hands on, less L21 D L21^T; tiles on and below the
// diagonal.
void FrontFactorizer::subtract_from_rest(const TileKernels& kernels, double* update) {
  const auto tile = [&](const AlignedArray& tiles, int t) {
    return tiles.data() + static_cast<std::int64_t>(t) * stride_;
  };
  const int next = begin_ + width_;
  for (int t = 0; t < rest_tiles_; ++t) {
    double* column = front_.data() + (next + kTile * t) * ld_;
    kernels.subtract_products(tile(lower_, t), rest_tiles_ - t, stride_, tile(product_, t), width_,
                              column + next + kTile * t, ld_);
    kernels.subtract_products(tile(lower_, rest_tiles_), tiles_ - rest_tiles_, stride_,
                              tile(product_, t), width_, column + padded(columns_), ld_);
  }
  const std::int64_t side = padded(rows_);
  for (int t = rest_tiles_; t < tiles_; ++t) {
    const std::int64_t place = kTile * (t - rest_tiles_);
    kernels.subtract_products(tile(lower_, t), tiles_ - t, stride_, tile(product_, t), width_,
                              update + place * side + place, side);
  }
}

void FrontFactorizer::store(double* values) const {
  values = store_inverse(inverse_.data(), width_, values);
  values = store_tiles(lower_.data(), stride_, rest_, width_, values);
  store_tiles(lower_.data() + static_cast<std::int64_t>(rest_tiles_) * stride_, stride_, rows_,
              width_, values);
}

}  // namespace timbre::detail
// NOLINTEND(bugprone-implicit-widening-of-multiplication-result)
