// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The opposite of gather_tuple (pack.hpp): N numbers of each lane to places that stand one after the other. Lanes with
// the same index must hold the same numbers.
#pragma once

#include "shoal/pack.hpp"

namespace shoal {
inline namespace SHOAL_ISA_NAMESPACE {
namespace simd {

/// Four numbers of each lane: rows become columns in registers, then one store a lane.
template <int Stride>
inline void scatter_four(const Pack* x, IndexPack index, double* base) {
#if defined(__AVX512F__)
  const auto put = [&](int lane, Raw both) {
    _mm256_storeu_pd(base + std::size_t{index[lane]} * Stride,
                     __builtin_shufflevector(both, both, 0, 1, 2, 3));
    _mm256_storeu_pd(base + std::size_t{index[lane + 4]} * Stride,
                     __builtin_shufflevector(both, both, 4, 5, 6, 7));
  };
  const Raw a = x[0].v, b = x[1].v, c = x[2].v, d = x[3].v;
  const Raw ab02 = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
  const Raw ab13 = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
  const Raw cd02 = __builtin_shufflevector(c, d, 0, 8, 2, 10, 4, 12, 6, 14);
  const Raw cd13 = __builtin_shufflevector(c, d, 1, 9, 3, 11, 5, 13, 7, 15);
  put(0, __builtin_shufflevector(ab02, cd02, 0, 1, 8, 9, 4, 5, 12, 13));
  put(1, __builtin_shufflevector(ab13, cd13, 0, 1, 8, 9, 4, 5, 12, 13));
  put(2, __builtin_shufflevector(ab02, cd02, 2, 3, 10, 11, 6, 7, 14, 15));
  put(3, __builtin_shufflevector(ab13, cd13, 2, 3, 10, 11, 6, 7, 14, 15));
#elif defined(__AVX__)
  const auto put = [&](int lane, Raw one) {
    _mm256_storeu_pd(base + std::size_t{index[lane]} * Stride, one);
  };
  const Raw a = x[0].v, b = x[1].v, c = x[2].v, d = x[3].v;
  const Raw ab02 = _mm256_unpacklo_pd(a, b), ab13 = _mm256_unpackhi_pd(a, b);
  const Raw cd02 = _mm256_unpacklo_pd(c, d), cd13 = _mm256_unpackhi_pd(c, d);
  put(0, _mm256_permute2f128_pd(ab02, cd02, 0x20));
  put(1, _mm256_permute2f128_pd(ab13, cd13, 0x20));
  put(2, _mm256_permute2f128_pd(ab02, cd02, 0x31));
  put(3, _mm256_permute2f128_pd(ab13, cd13, 0x31));
#else
  for (int lane = 0; lane < lanes; ++lane)
    for (int k = 0; k < 4; ++k) base[std::size_t{index[lane]} * Stride + std::size_t(k)] = x[k][lane];
#endif
}

}  // namespace simd

/// base[index * Stride + k] = x[k], k = 0 ... N - 1, in each lane.
template <int N, int Stride = N>
inline void scatter_tuple(const Pack* x, IndexPack index, double* base) {
  if constexpr (N >= 4) {
    simd::scatter_four<Stride>(x, index, base);
    if constexpr (N > 4) scatter_tuple<N - 4, Stride>(x + 4, index, base + 4);
  } else {
    double numbers[N][lanes];
    for (int k = 0; k < N; ++k) x[k].store(numbers[k]);
    for (int lane = 0; lane < lanes; ++lane)
      for (int k = 0; k < N; ++k) base[std::size_t{index[lane]} * Stride + std::size_t(k)] = numbers[k][lane];
  }
}

}  // namespace SHOAL_ISA_NAMESPACE
}  // namespace shoal
