#pragma once

// Included only by the files that are compiled for an instruction set.

namespace timbre::detail {
namespace {

/// A vector register of so many doubles.
template <int Lanes>
struct Simd;
template <>
struct Simd<2> {
  typedef double Vector __attribute__((vector_size(16), aligned(8), may_alias));
};
template <>
struct Simd<4> {
  typedef double Vector __attribute__((vector_size(32), aligned(8), may_alias));
};
template <>
struct Simd<8> {
  typedef double Vector __attribute__((vector_size(64), aligned(8), may_alias));
};

}  // namespace
}  // namespace timbre::detail
