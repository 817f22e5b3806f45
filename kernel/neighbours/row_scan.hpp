// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The inner loop of neighbour search: of runs of sorted particles, write those nearer than the radius. Included by
// neighbour_list.cpp only.
//
// Two thirds of the candidates fail, unpredictably, so no path branches on the result; a branching loop is ten times
// slower. Neither do the SIMD paths branch on the end of a run: runs are cut into steps of one vector first, and one
// loop goes over the steps of all of them. All paths give the same neighbours in the same order.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#if defined(__AVX2__)
#include <immintrin.h>
#endif

#include "kernel/neighbours/run_finder.hpp"

namespace shoal::kernel {

/// Sorted particles begin ... end-1.
struct Run {
  std::uint32_t begin, end;
};

/// Of whom neighbours are sought, and among whom. Arrays hold D coordinates; `self` is the particle to leave out.
template <int D>
struct RowTarget {
  double x[D];
  double squared_radius;
  std::uint32_t self;
  const double* sorted[D];
  const std::uint32_t* order;
};

/// Paths write up to this many entries beyond the last neighbour and read as many beyond the end of a run.
inline constexpr std::size_t scan_overrun = 8;

/// One candidate at a time.
struct PlainScan {
  static constexpr std::uint32_t width = 1;

  template <int D>
  static std::uint32_t* scan(const RowTarget<D>& t, Run run, std::uint32_t* out) {
    for (std::uint32_t k = run.begin; k < run.end; ++k) {
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

/// Steps of four candidates; step s holds those at begin[s] ... begin[s] + left[s] - 1.
struct Avx2Scan {
  static constexpr std::uint32_t width = 4;

  template <int D>
  static std::uint32_t* scan(const RowTarget<D>& t, const std::uint32_t* begin, const std::uint32_t* left,
                             std::size_t steps, std::uint32_t* out) {
    const __m256d radius2 = _mm256_set1_pd(t.squared_radius);
    const __m128i self = _mm_set1_epi32(static_cast<int>(t.self));
    __m256d x[D];
    const double* sorted[D];  // copies: stores to `out` could otherwise change the originals
    const std::uint32_t* const order = t.order;
    for (int a = 0; a < D; ++a) {
      x[a] = _mm256_set1_pd(t.x[a]);
      sorted[a] = t.sorted[a];
    }
    for (std::size_t s = 0; s < steps; ++s) {
      const std::size_t k = begin[s];
      __m256d r2 = _mm256_setzero_pd();
      for (int a = 0; a < D; ++a) {
        const __m256d d = _mm256_sub_pd(_mm256_loadu_pd(sorted[a] + k), x[a]);
        r2 = _mm256_add_pd(r2, _mm256_mul_pd(d, d));
      }
      const __m128i index = _mm_loadu_si128(reinterpret_cast<const __m128i*>(order + k));
      const auto near = static_cast<unsigned>(_mm256_movemask_pd(_mm256_cmp_pd(r2, radius2, _CMP_LT_OQ)));
      const auto same =
          static_cast<unsigned>(_mm_movemask_ps(_mm_castsi128_ps(_mm_cmpeq_epi32(index, self))));
      const unsigned hit = _bzhi_u32(near & ~same, left[s]);
      const __m128i shuffle = _mm_load_si128(reinterpret_cast<const __m128i*>(compress_table.bytes[hit]));
      _mm_storeu_si128(reinterpret_cast<__m128i*>(out), _mm_shuffle_epi8(index, shuffle));
      out += std::popcount(hit);
    }
    return out;
  }
};
#endif

#if defined(__AVX512F__) && defined(__AVX512VL__)
/// Steps of eight candidates.
struct Avx512Scan {
  static constexpr std::uint32_t width = 8;

  template <int D>
  static std::uint32_t* scan(const RowTarget<D>& t, const std::uint32_t* begin, const std::uint32_t* left,
                             std::size_t steps, std::uint32_t* out) {
    const __m512d radius2 = _mm512_set1_pd(t.squared_radius);
    const __m256i self = _mm256_set1_epi32(static_cast<int>(t.self));
    __m512d x[D];
    const double* sorted[D];  // copies: stores to `out` could otherwise change the originals
    const std::uint32_t* const order = t.order;
    for (int a = 0; a < D; ++a) {
      x[a] = _mm512_set1_pd(t.x[a]);
      sorted[a] = t.sorted[a];
    }
    for (std::size_t s = 0; s < steps; ++s) {
      const std::size_t k = begin[s];
      __m512d r2 = _mm512_setzero_pd();
      for (int a = 0; a < D; ++a) {
        const __m512d d = _mm512_sub_pd(_mm512_loadu_pd(sorted[a] + k), x[a]);
        r2 = _mm512_add_pd(r2, _mm512_mul_pd(d, d));
      }
      const __m256i index = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(order + k));
      const auto inside = static_cast<__mmask8>(_bzhi_u32(0xFFu, left[s]));
      const __mmask8 near = _mm512_mask_cmp_pd_mask(inside, r2, radius2, _CMP_LT_OQ);
      const __mmask8 hit = _mm256_mask_cmpneq_epi32_mask(near, index, self);
      // Compressing in a register and storing all of it is faster than a compressing store.
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

#if defined(__AVX2__)
/// Runs cut into steps of Width candidates, up to `at_once` of them without a branch: most runs have fewer.
template <std::uint32_t Width>
class StepList {
 public:
  static constexpr std::uint32_t at_once = 8;
  static constexpr std::size_t capacity = 256;

  /// Adds the steps of at most at_once * Width candidates.
  void add(std::uint32_t first, std::uint32_t length) {
    const __m256i ahead =
        _mm256_mullo_epi32(_mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7), _mm256_set1_epi32(Width));
    const __m256i place = _mm256_add_epi32(_mm256_set1_epi32(static_cast<int>(first)), ahead);
    const __m256i rest = _mm256_sub_epi32(_mm256_set1_epi32(static_cast<int>(length)), ahead);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(begin_ + n_), place);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(left_ + n_), rest);
    n_ += (length + Width - 1) / Width;
  }
  bool is_full() const { return n_ > capacity - at_once; }
  void clear() { n_ = 0; }

  const std::uint32_t* begin() const { return begin_; }
  /// Candidates left in the run at each step; at most 64, since bzhi looks at 8 bits.
  const std::uint32_t* left() const { return left_; }
  std::size_t size() const { return n_; }

 private:
  std::uint32_t begin_[capacity], left_[capacity];
  std::size_t n_ = 0;
};
#endif

/// Scans the runs of place i of a block; the neighbours stand at `out` up to the returned end.
template <int D, class Scan>
std::uint32_t* scan_runs(const RowTarget<D>& target, const RunBlock<D>& block, std::size_t i,
                         std::uint32_t* out) {
  if constexpr (Scan::width == 1) {
    for (std::size_t r = 0; r < block.runs; ++r)
      out = Scan::scan(target, {block.begin[r][i], block.end[r][i]}, out);
  } else {
#if defined(__AVX2__)
    StepList<Scan::width> steps;
    constexpr std::uint32_t part = steps.at_once * Scan::width;
    for (std::size_t r = 0; r < block.runs; ++r) {
      std::uint32_t first = block.begin[r][i], length = block.end[r][i] - first;
      for (; length > part || steps.is_full();
           first += std::min(part, length), length -= std::min(part, length)) {
        if (steps.is_full()) {
          out = Scan::scan(target, steps.begin(), steps.left(), steps.size(), out);
          steps.clear();
        }
        steps.add(first, std::min(part, length));
      }
      steps.add(first, length);
    }
    out = Scan::scan(target, steps.begin(), steps.left(), steps.size(), out);
#endif
  }
  return out;
}

}  // namespace shoal::kernel
