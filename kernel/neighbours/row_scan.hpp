// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The inner loop of neighbour search: of the sorted particles begin ... end-1 of a row, write those nearer than the
// radius. Included by neighbour_list.cpp only.
//
// Nine in ten candidates fail or pass unpredictably, so no path branches on the result; a branching loop is ten
// times slower (27 against 2.6 ns per neighbour). All paths give the same neighbours in the same order.
#pragma once

#include <bit>
#include <cstdint>

#if defined(__AVX2__)
#include <immintrin.h>
#endif

namespace shoal::kernel {

/// Of whom neighbours are sought, and among whom. Arrays hold D coordinates; `self` is the particle to leave out.
template <int D>
struct RowTarget {
  double x[D];
  double squared_radius;
  std::uint32_t self;
  const double* sorted[D];
  const std::uint32_t* order;
};

/// Paths write up to this many entries beyond the last neighbour and read as many beyond `end`.
inline constexpr std::size_t scan_overrun = 8;

struct PlainScan {
  template <int D>
  static std::uint32_t* run(const RowTarget<D>& t, std::uint32_t begin, std::uint32_t end, std::uint32_t* out) {
    for (std::uint32_t k = begin; k < end; ++k) {
      double r2 = 0.0;
      for (int a = 0; a < D; ++a) {
        const double d = t.sorted[a][k] - t.x[a];
        r2 += d * d;
      }
      *out = t.order[k];
      out += static_cast<int>(r2 < t.squared_radius) & static_cast<int>(t.order[k] != t.self);
    }
    return out;
  }
};

#if defined(__AVX2__)
// For each set of four lanes the byte shuffle that moves them to the front: AVX2 has no compress instruction.
struct CompressTable {
  alignas(16) std::uint8_t bytes[16][16];

  constexpr CompressTable() : bytes{} {
    for (int set = 0; set < 16; ++set) {
      int next = 0;
      for (int lane = 0; lane < 4; ++lane) {
        if (((set >> lane) & 1) == 0) continue;
        for (int b = 0; b < 4; ++b) bytes[set][4 * next + b] = static_cast<std::uint8_t>(4 * lane + b);
        ++next;
      }
      for (int b = 4 * next; b < 16; ++b) bytes[set][b] = 0x80;
    }
  }
};
inline constexpr CompressTable compress_table{};

struct Avx2Scan {
  template <int D>
  static std::uint32_t* run(const RowTarget<D>& t, std::uint32_t begin, std::uint32_t end, std::uint32_t* out) {
    const __m256d radius2 = _mm256_set1_pd(t.squared_radius);
    const __m128i self = _mm_set1_epi32(static_cast<int>(t.self));
    __m256d x[D];
    for (int a = 0; a < D; ++a) x[a] = _mm256_set1_pd(t.x[a]);
    for (std::uint32_t k = begin; k < end; k += 4) {
      __m256d r2 = _mm256_setzero_pd();
      for (int a = 0; a < D; ++a) {
        const __m256d d = _mm256_sub_pd(_mm256_loadu_pd(t.sorted[a] + k), x[a]);
        r2 = _mm256_add_pd(r2, _mm256_mul_pd(d, d));
      }
      const __m128i index = _mm_loadu_si128(reinterpret_cast<const __m128i*>(t.order + k));
      const int near = _mm256_movemask_pd(_mm256_cmp_pd(r2, radius2, _CMP_LT_OQ));
      const int same = _mm_movemask_ps(_mm_castsi128_ps(_mm_cmpeq_epi32(index, self)));
      const std::uint32_t left = end - k;
      const int inside = left >= 4 ? 15 : (1 << left) - 1;
      const int hit = near & inside & ~same;
      const __m128i shuffle = _mm_load_si128(reinterpret_cast<const __m128i*>(compress_table.bytes[hit]));
      _mm_storeu_si128(reinterpret_cast<__m128i*>(out), _mm_shuffle_epi8(index, shuffle));
      out += std::popcount(static_cast<unsigned>(hit));
    }
    return out;
  }
};
#endif

#if defined(__AVX512F__) && defined(__AVX512VL__)
struct Avx512Scan {
  template <int D>
  static std::uint32_t* run(const RowTarget<D>& t, std::uint32_t begin, std::uint32_t end, std::uint32_t* out) {
    const __m512d radius2 = _mm512_set1_pd(t.squared_radius);
    const __m256i self = _mm256_set1_epi32(static_cast<int>(t.self));
    __m512d x[D];
    for (int a = 0; a < D; ++a) x[a] = _mm512_set1_pd(t.x[a]);
    for (std::uint32_t k = begin; k < end; k += 8) {
      __m512d r2 = _mm512_setzero_pd();
      for (int a = 0; a < D; ++a) {
        const __m512d d = _mm512_sub_pd(_mm512_loadu_pd(t.sorted[a] + k), x[a]);
        r2 = _mm512_add_pd(r2, _mm512_mul_pd(d, d));
      }
      const __m256i index = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(t.order + k));
      const std::uint32_t left = end - k;
      const auto inside = static_cast<__mmask8>(left >= 8 ? 0xFFu : (1u << left) - 1u);
      const __mmask8 near = _mm512_mask_cmp_pd_mask(inside, r2, radius2, _CMP_LT_OQ);
      const __mmask8 hit = _mm256_mask_cmpneq_epi32_mask(near, index, self);
      // Compressing in a register and storing all of it is faster than a compressing store on every CPU.
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), _mm256_maskz_compress_epi32(hit, index));
      out += std::popcount(static_cast<unsigned>(hit));
    }
    return out;
  }
};
using FastestScan = Avx512Scan;
#elif defined(__AVX2__)
using FastestScan = Avx2Scan;
#else
using FastestScan = PlainScan;
#endif

}  // namespace shoal::kernel
