// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The part of Pack that differs between instruction sets: one section for each. Included by pack.hpp only.
//
// Typedefs with vector_size must not depend on a template parameter: gcc 12 then confuses the vector with its
// element in overloads. Under AVX-512 the zero-masked intrinsics with a full mask are used because gcc 12 warns of
// uninitialised variables inside the unmasked ones; the code they give is the same.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#if defined(__AVX__)
#include <immintrin.h>
#endif

namespace shoal {
inline namespace SHOAL_ISA_NAMESPACE {
namespace simd {

#if defined(__AVX512F__)

inline constexpr int lanes = 8;
using Raw = __m512d;
using RawMask = __mmask8;
using RawIndex = __m256i;
inline constexpr __mmask8 full_mask = 0xFF;

inline Raw broadcast(double x) { return _mm512_set1_pd(x); }
inline Raw load(const double* p) { return _mm512_loadu_pd(p); }
inline void store(double* p, Raw a) { _mm512_storeu_pd(p, a); }
inline Raw load(const float* p) { return _mm512_maskz_cvtps_pd(full_mask, _mm256_loadu_ps(p)); }
inline void store(float* p, Raw a) { _mm256_storeu_ps(p, _mm512_maskz_cvtpd_ps(full_mask, a)); }
inline double get_lane(Raw a, int k) { return a[k]; }
inline void set_lane(Raw& a, int k, double x) { a[k] = x; }
inline RawMask less(Raw a, Raw b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
inline RawMask less_equal(Raw a, Raw b) { return _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ); }
inline RawMask equal(Raw a, Raw b) { return _mm512_cmp_pd_mask(a, b, _CMP_EQ_OQ); }
inline Raw select(RawMask m, Raw a, Raw b) { return _mm512_mask_blend_pd(m, b, a); }
inline Raw min(Raw a, Raw b) { return _mm512_maskz_min_pd(full_mask, a, b); }
inline Raw max(Raw a, Raw b) { return _mm512_maskz_max_pd(full_mask, a, b); }
inline Raw sqrt(Raw a) { return _mm512_maskz_sqrt_pd(full_mask, a); }
// From 14 bits by two steps of Newton's rule: within 2 units in the last place at a third of the time of root and
// division, which are what pair loops wait for. The same for 1 / a.
inline constexpr bool fast_inverse_sqrt = true;
inline Raw inverse_sqrt(Raw a) {
  const Raw one = broadcast(1.0), half = broadcast(0.5);
  Raw y = _mm512_maskz_rsqrt14_pd(full_mask, a);
  for (int k = 0; k < 2; ++k) {
    const Raw rest = _mm512_fnmadd_pd(a * y, y, one);  // 1 - a y^2
    y = _mm512_fmadd_pd(half * y, rest, y);
  }
  return y;
}
inline Raw reciprocal(Raw a) {
  const Raw one = broadcast(1.0);
  Raw y = _mm512_maskz_rcp14_pd(full_mask, a);
  for (int k = 0; k < 2; ++k) y = _mm512_fmadd_pd(y, _mm512_fnmadd_pd(a, y, one), y);
  return y;
}
inline Raw abs(Raw a) {
  return _mm512_castsi512_pd(
      _mm512_and_epi64(_mm512_castpd_si512(a), _mm512_set1_epi64(0x7FFFFFFFFFFFFFFFLL)));
}
inline double sum(Raw a) {
  const __m256d four = __builtin_shufflevector(a, a, 0, 1, 2, 3) + __builtin_shufflevector(a, a, 4, 5, 6, 7);
  const __m128d two = __builtin_shufflevector(four, four, 0, 1) + __builtin_shufflevector(four, four, 2, 3);
  return two[0] + two[1];
}
inline RawMask mask_all(bool b) { return b ? full_mask : RawMask{0}; }
inline RawMask mask_and(RawMask a, RawMask b) { return static_cast<RawMask>(a & b); }
inline RawMask mask_or(RawMask a, RawMask b) { return static_cast<RawMask>(a | b); }
inline RawMask mask_not(RawMask a) { return static_cast<RawMask>(a ^ full_mask); }
inline bool mask_any(RawMask a) { return a != 0; }
inline bool mask_lane(RawMask a, int k) { return ((a >> k) & 1) != 0; }
inline RawMask first_lanes(std::int64_t n) {  // without branches: where a row ends is hard to foresee
  return static_cast<RawMask>(
      _bzhi_u32(full_mask, static_cast<unsigned>(std::clamp<std::int64_t>(n, 0, lanes))));
}

inline RawIndex load_index(const std::uint32_t* p) {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p));
}
// A gather merges into its register and so waits for what was in it. The compiler, which sees a full mask, leaves there
// what comes its way, e.g. the end of the last root; zeros that it cannot see through cost nothing (measured: pairs take
// two thirds of the time).
template <int Stride>
inline Raw gather(const double* base, RawIndex index) {
  const __m256i scaled = Stride == 1 ? index : _mm256_mullo_epi32(index, _mm256_set1_epi32(Stride));
  Raw zero = _mm512_setzero_pd();
  RawMask all = full_mask;
#if defined(__GNUC__)
  asm("" : "+v"(zero), "+Yk"(all));
#endif
  return _mm512_mask_i32gather_pd(zero, all, scaled, base, 8);
}

// p[2 lane + k] in lane of out[k].
inline void load_pairs(const double* p, Raw* out) {
  const Raw a = load(p), b = load(p + lanes);
  out[0] = __builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14);
  out[1] = __builtin_shufflevector(a, b, 1, 3, 5, 7, 9, 11, 13, 15);
}

// columns[c * lanes + lane] = row[lane][c]
inline void transpose(const std::uint32_t* const* row, std::uint32_t* columns) {
  __m256i a[8], b[8];
  for (int k = 0; k < 8; ++k) a[k] = load_index(row[k]);
  for (int k = 0; k < 8; k += 2) {
    b[k] = _mm256_unpacklo_epi32(a[k], a[k + 1]);
    b[k + 1] = _mm256_unpackhi_epi32(a[k], a[k + 1]);
  }
  for (int k = 0; k < 8; k += 4) {
    a[k] = _mm256_unpacklo_epi64(b[k], b[k + 2]);
    a[k + 1] = _mm256_unpackhi_epi64(b[k], b[k + 2]);
    a[k + 2] = _mm256_unpacklo_epi64(b[k + 1], b[k + 3]);
    a[k + 3] = _mm256_unpackhi_epi64(b[k + 1], b[k + 3]);
  }
  for (int k = 0; k < 4; ++k) {
    auto* out = reinterpret_cast<__m256i*>(columns + 8 * k);
    _mm256_store_si256(out, _mm256_permute2x128_si256(a[k], a[k + 4], 0x20));
    _mm256_store_si256(out + 4, _mm256_permute2x128_si256(a[k], a[k + 4], 0x31));
  }
}

// Numbers that lie together are read together and transposed, at less than half the cost of gathering each. [a] is
// the `N`-tuple of lane a; pairs of lanes a, a + 4 share a register.
template <int N, int Stride>
inline void gather_tuple(const double* base, const std::uint32_t* j, Raw* out) {
  const auto at = [&](int lane) { return base + std::size_t{j[lane]} * Stride; };
  if constexpr (N == 2) {
    const auto four = [&](int a) {
      Raw r = _mm512_maskz_loadu_pd(0x03, at(a));
      r = _mm512_mask_broadcast_f64x2(r, 0x0C, _mm_loadu_pd(at(a + 2)));
      r = _mm512_mask_broadcast_f64x2(r, 0x30, _mm_loadu_pd(at(a + 4)));
      return _mm512_mask_broadcast_f64x2(r, 0xC0, _mm_loadu_pd(at(a + 6)));
    };
    const Raw even = four(0), odd = four(1);
    out[0] = __builtin_shufflevector(even, odd, 0, 8, 2, 10, 4, 12, 6, 14);
    out[1] = __builtin_shufflevector(even, odd, 1, 9, 3, 11, 5, 13, 7, 15);
  } else {  // 3 reads a fourth number and leaves it
    const auto two = [&](int a) {
      return __builtin_shufflevector(_mm256_loadu_pd(at(a)), _mm256_loadu_pd(at(a + 4)), 0, 1, 2, 3, 4, 5, 6,
                                     7);
    };
    const Raw a = two(0), b = two(1), c = two(2), d = two(3);
    const Raw ab02 = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
    const Raw ab13 = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
    const Raw cd02 = __builtin_shufflevector(c, d, 0, 8, 2, 10, 4, 12, 6, 14);
    const Raw cd13 = __builtin_shufflevector(c, d, 1, 9, 3, 11, 5, 13, 7, 15);
    out[0] = __builtin_shufflevector(ab02, cd02, 0, 1, 8, 9, 4, 5, 12, 13);
    out[1] = __builtin_shufflevector(ab13, cd13, 0, 1, 8, 9, 4, 5, 12, 13);
    out[2] = __builtin_shufflevector(ab02, cd02, 2, 3, 10, 11, 6, 7, 14, 15);
    if constexpr (N == 4) out[3] = __builtin_shufflevector(ab13, cd13, 2, 3, 10, 11, 6, 7, 14, 15);
  }
}

// Sums of bits without sign: those of NaN, infinity and negative numbers would overflow.
typedef std::uint64_t Bits __attribute__((vector_size(64)));
inline __m512i add_bits(__m512i a, __m512i b) {
  return reinterpret_cast<__m512i>(reinterpret_cast<Bits>(a) + reinterpret_cast<Bits>(b));
}
inline __m512i subtract_bits(__m512i a, __m512i b) {
  return reinterpret_cast<__m512i>(reinterpret_cast<Bits>(a) - reinterpret_cast<Bits>(b));
}

// For pack_math.hpp. 2^n, where `shifted` is the whole number n (-1022 <= n <= 1023) plus 1.5 * 2^52.
inline Raw power_of_two(Raw shifted) {
  const __m512i bits = _mm512_castpd_si512(shifted) << 52;
  return _mm512_castsi512_pd(add_bits(bits, _mm512_castpd_si512(broadcast(1.0))));
}
// x = mantissa * 2^n with sqrt(1/2) <= mantissa < sqrt(2), for normal x > 0; returns n.
inline Raw split_exponent(Raw x, Raw& mantissa) {
  const __m512i one = _mm512_castpd_si512(broadcast(1.0)), bits = _mm512_castpd_si512(x);
  const __m512i root = _mm512_castpd_si512(broadcast(0.70710678118654752));
  const __m512i biased = add_bits(subtract_bits(bits, root), one) >> 52;
  mantissa = _mm512_castsi512_pd(add_bits(subtract_bits(bits, biased << 52), one));
  const Raw shift = broadcast(0x1.8p52);
  return _mm512_castsi512_pd(biased + _mm512_castpd_si512(shift)) - (shift + broadcast(1023.0));
}
// a 2^n for whole n; infinity and 0 where that is out of range.
inline constexpr bool fast_scale = true;
inline Raw scale(Raw a, Raw n) { return _mm512_maskz_scalef_pd(full_mask, a, n); }

#elif defined(__AVX__)

inline constexpr int lanes = 4;
using Raw = __m256d;
using RawMask = __m256d;  // all bits of a lane set or none
using RawIndex = __m128i;

inline Raw broadcast(double x) { return _mm256_set1_pd(x); }
inline Raw load(const double* p) { return _mm256_loadu_pd(p); }
inline void store(double* p, Raw a) { _mm256_storeu_pd(p, a); }
inline Raw load(const float* p) { return _mm256_cvtps_pd(_mm_loadu_ps(p)); }
inline void store(float* p, Raw a) { _mm_storeu_ps(p, _mm256_cvtpd_ps(a)); }
inline double get_lane(Raw a, int k) { return a[k]; }
inline void set_lane(Raw& a, int k, double x) { a[k] = x; }
inline RawMask less(Raw a, Raw b) { return _mm256_cmp_pd(a, b, _CMP_LT_OQ); }
inline RawMask less_equal(Raw a, Raw b) { return _mm256_cmp_pd(a, b, _CMP_LE_OQ); }
inline RawMask equal(Raw a, Raw b) { return _mm256_cmp_pd(a, b, _CMP_EQ_OQ); }
inline Raw select(RawMask m, Raw a, Raw b) { return _mm256_blendv_pd(b, a, m); }
inline Raw min(Raw a, Raw b) { return _mm256_min_pd(a, b); }
inline Raw max(Raw a, Raw b) { return _mm256_max_pd(a, b); }
inline Raw sqrt(Raw a) { return _mm256_sqrt_pd(a); }
inline constexpr bool fast_inverse_sqrt = false;
inline Raw inverse_sqrt(Raw a) { return _mm256_set1_pd(1.0) / _mm256_sqrt_pd(a); }
inline Raw reciprocal(Raw a) { return _mm256_set1_pd(1.0) / a; }
inline Raw abs(Raw a) { return _mm256_andnot_pd(_mm256_set1_pd(-0.0), a); }
inline double sum(Raw a) {
  const __m128d two = _mm256_castpd256_pd128(a) + _mm256_extractf128_pd(a, 1);
  return two[0] + two[1];
}
inline RawMask mask_all(bool b) { return _mm256_castsi256_pd(_mm256_set1_epi64x(b ? -1 : 0)); }
inline RawMask mask_and(RawMask a, RawMask b) { return _mm256_and_pd(a, b); }
inline RawMask mask_or(RawMask a, RawMask b) { return _mm256_or_pd(a, b); }
inline RawMask mask_not(RawMask a) { return _mm256_xor_pd(a, mask_all(true)); }
inline bool mask_any(RawMask a) { return _mm256_movemask_pd(a) != 0; }
inline bool mask_lane(RawMask a, int k) { return ((_mm256_movemask_pd(a) >> k) & 1) != 0; }
inline RawMask first_lanes(std::int64_t n) {
  return less(_mm256_setr_pd(0, 1, 2, 3), broadcast(static_cast<double>(n)));
}

inline RawIndex load_index(const std::uint32_t* p) {
  return _mm_loadu_si128(reinterpret_cast<const __m128i*>(p));
}
template <int Stride>
inline Raw gather(const double* base, RawIndex index) {
#if defined(__AVX2__)
  const __m128i scaled = Stride == 1 ? index : _mm_mullo_epi32(index, _mm_set1_epi32(Stride));
  return _mm256_mask_i32gather_pd(_mm256_setzero_pd(), base, scaled, mask_all(true), 8);
#else
  alignas(16) std::uint32_t x[lanes];
  _mm_store_si128(reinterpret_cast<__m128i*>(x), index);
  return _mm256_setr_pd(base[std::size_t{x[0]} * Stride], base[std::size_t{x[1]} * Stride],
                        base[std::size_t{x[2]} * Stride], base[std::size_t{x[3]} * Stride]);
#endif
}

// p[2 lane + k] in lane of out[k].
inline void load_pairs(const double* p, Raw* out) {
  const Raw a = load(p), b = load(p + lanes);
  out[0] = __builtin_shufflevector(a, b, 0, 2, 4, 6);
  out[1] = __builtin_shufflevector(a, b, 1, 3, 5, 7);
}

// columns[c * lanes + lane] = row[lane][c]
inline void transpose(const std::uint32_t* const* row, std::uint32_t* columns) {
  for (int lane = 0; lane < lanes; ++lane)
    for (int c = 0; c < lanes; ++c) columns[c * lanes + lane] = row[lane][c];
}

template <int N, int Stride>
inline void gather_tuple(const double* base, const std::uint32_t* j, Raw* out) {
  const auto at = [&](int lane) { return base + std::size_t{j[lane]} * Stride; };
  if constexpr (N == 2) {
    const auto two = [&](int a) {
      return __builtin_shufflevector(_mm_loadu_pd(at(a)), _mm_loadu_pd(at(a + 2)), 0, 1, 2, 3);
    };
    const Raw even = two(0), odd = two(1);
    out[0] = _mm256_unpacklo_pd(even, odd);
    out[1] = _mm256_unpackhi_pd(even, odd);
  } else {  // 3 reads a fourth number and leaves it
    const Raw a = load(at(0)), b = load(at(1)), c = load(at(2)), d = load(at(3));
    const Raw ab02 = _mm256_unpacklo_pd(a, b), ab13 = _mm256_unpackhi_pd(a, b);
    const Raw cd02 = _mm256_unpacklo_pd(c, d), cd13 = _mm256_unpackhi_pd(c, d);
    out[0] = _mm256_permute2f128_pd(ab02, cd02, 0x20);
    out[1] = _mm256_permute2f128_pd(ab13, cd13, 0x20);
    out[2] = _mm256_permute2f128_pd(ab02, cd02, 0x31);
    if constexpr (N == 4) out[3] = _mm256_permute2f128_pd(ab13, cd13, 0x31);
  }
}

// Sums of bits without sign: those of NaN, infinity and negative numbers would overflow.
typedef std::uint64_t Bits __attribute__((vector_size(32)));
inline __m256i add_bits(__m256i a, __m256i b) {
  return reinterpret_cast<__m256i>(reinterpret_cast<Bits>(a) + reinterpret_cast<Bits>(b));
}
inline __m256i subtract_bits(__m256i a, __m256i b) {
  return reinterpret_cast<__m256i>(reinterpret_cast<Bits>(a) - reinterpret_cast<Bits>(b));
}

// For pack_math.hpp. 2^n, where `shifted` is the whole number n (-1022 <= n <= 1023) plus 1.5 * 2^52.
inline Raw power_of_two(Raw shifted) {
  const __m256i bits = _mm256_castpd_si256(shifted) << 52;
  return _mm256_castsi256_pd(add_bits(bits, _mm256_castpd_si256(broadcast(1.0))));
}
// x = mantissa * 2^n with sqrt(1/2) <= mantissa < sqrt(2), for normal x > 0; returns n.
inline Raw split_exponent(Raw x, Raw& mantissa) {
  const __m256i one = _mm256_castpd_si256(broadcast(1.0)), bits = _mm256_castpd_si256(x);
  const __m256i root = _mm256_castpd_si256(broadcast(0.70710678118654752));
  const __m256i biased = add_bits(subtract_bits(bits, root), one) >> 52;
  mantissa = _mm256_castsi256_pd(add_bits(subtract_bits(bits, biased << 52), one));
  const Raw shift = broadcast(0x1.8p52);
  return _mm256_castsi256_pd(biased + _mm256_castpd_si256(shift)) - (shift + broadcast(1023.0));
}
inline constexpr bool fast_scale = false;
inline Raw scale(Raw a, Raw) { return a; }

#else  // two vectors of 16 bytes: SSE2, NEON and their like; wider vectors would change the calling convention

inline constexpr int lanes = 4;
typedef double Double2 __attribute__((vector_size(16)));
typedef std::int64_t Long2 __attribute__((vector_size(16)));

struct Raw {
  Double2 half[2];

  friend Raw operator-(Raw a) { return {{-a.half[0], -a.half[1]}}; }
  friend Raw operator+(Raw a, Raw b) { return {{a.half[0] + b.half[0], a.half[1] + b.half[1]}}; }
  friend Raw operator-(Raw a, Raw b) { return {{a.half[0] - b.half[0], a.half[1] - b.half[1]}}; }
  friend Raw operator*(Raw a, Raw b) { return {{a.half[0] * b.half[0], a.half[1] * b.half[1]}}; }
  friend Raw operator/(Raw a, Raw b) { return {{a.half[0] / b.half[0], a.half[1] / b.half[1]}}; }
};
struct RawMask {
  Long2 half[2];
};
struct RawIndex {
  std::uint32_t lane[lanes];
};

// Sums of bits without sign: those of NaN, infinity and negative numbers would overflow.
typedef std::uint64_t Bits __attribute__((vector_size(16)));
inline Long2 add_bits(Long2 a, Long2 b) {
  return reinterpret_cast<Long2>(reinterpret_cast<Bits>(a) + reinterpret_cast<Bits>(b));
}
inline Long2 subtract_bits(Long2 a, Long2 b) {
  return reinterpret_cast<Long2>(reinterpret_cast<Bits>(a) - reinterpret_cast<Bits>(b));
}
inline Double2 bits_to_double(Long2 a) { return reinterpret_cast<Double2>(a); }
inline Long2 bits_to_long(Double2 a) { return reinterpret_cast<Long2>(a); }
inline Double2 select_half(Long2 m, Double2 a, Double2 b) {
  return bits_to_double((m & bits_to_long(a)) | (~m & bits_to_long(b)));
}

inline Raw broadcast(double x) { return {{Double2{x, x}, Double2{x, x}}}; }
inline Raw load(const double* p) { return {{Double2{p[0], p[1]}, Double2{p[2], p[3]}}}; }
inline void store(double* p, Raw a) { std::memcpy(p, a.half, sizeof a.half); }
inline Raw load(const float* p) { return {{Double2{p[0], p[1]}, Double2{p[2], p[3]}}}; }
inline void store(float* p, Raw a) {
  for (int k = 0; k < lanes; ++k) p[k] = static_cast<float>(a.half[k / 2][k % 2]);
}
inline double get_lane(Raw a, int k) { return a.half[k / 2][k % 2]; }
inline void set_lane(Raw& a, int k, double x) { a.half[k / 2][k % 2] = x; }
inline RawMask less(Raw a, Raw b) { return {{Long2(a.half[0] < b.half[0]), Long2(a.half[1] < b.half[1])}}; }
inline RawMask less_equal(Raw a, Raw b) {
  return {{Long2(a.half[0] <= b.half[0]), Long2(a.half[1] <= b.half[1])}};
}
inline RawMask equal(Raw a, Raw b) {
  return {{Long2(a.half[0] == b.half[0]), Long2(a.half[1] == b.half[1])}};
}
inline Raw select(RawMask m, Raw a, Raw b) {
  return {{select_half(m.half[0], a.half[0], b.half[0]), select_half(m.half[1], a.half[1], b.half[1])}};
}
inline Raw min(Raw a, Raw b) { return select(less(a, b), a, b); }
inline Raw max(Raw a, Raw b) { return select(less(b, a), a, b); }
inline Raw sqrt(Raw a) {
  for (int k = 0; k < lanes; ++k) set_lane(a, k, std::sqrt(get_lane(a, k)));
  return a;
}
inline constexpr bool fast_inverse_sqrt = false;
// Nothing here approximates a root in less time: both are the root of each lane
// and a division.
inline Raw inverse_sqrt(Raw a) { return broadcast(1.0) / sqrt(a); }
inline Raw reciprocal(Raw a) { return broadcast(1.0) / a; }
inline Raw abs(Raw a) {
  const Long2 magnitude = {0x7FFFFFFFFFFFFFFFLL, 0x7FFFFFFFFFFFFFFFLL};
  return {{bits_to_double(bits_to_long(a.half[0]) & magnitude),
           bits_to_double(bits_to_long(a.half[1]) & magnitude)}};
}
inline double sum(Raw a) {
  const Double2 two = a.half[0] + a.half[1];
  return two[0] + two[1];
}
inline RawMask mask_all(bool b) {
  const std::int64_t x = b ? -1 : 0;
  return {{Long2{x, x}, Long2{x, x}}};
}
inline RawMask mask_and(RawMask a, RawMask b) { return {{a.half[0] & b.half[0], a.half[1] & b.half[1]}}; }
inline RawMask mask_or(RawMask a, RawMask b) { return {{a.half[0] | b.half[0], a.half[1] | b.half[1]}}; }
inline RawMask mask_not(RawMask a) { return {{~a.half[0], ~a.half[1]}}; }
inline bool mask_lane(RawMask a, int k) { return a.half[k / 2][k % 2] != 0; }
inline bool mask_any(RawMask a) {
  const Long2 both = a.half[0] | a.half[1];
  return (both[0] | both[1]) != 0;
}
inline RawMask first_lanes(std::int64_t n) {
  const Long2 limit = {n, n};
  return {{Long2(Long2{0, 1} < limit), Long2(Long2{2, 3} < limit)}};
}

inline RawIndex load_index(const std::uint32_t* p) { return {{p[0], p[1], p[2], p[3]}}; }
template <int Stride>
inline Raw gather(const double* base, RawIndex index) {
  const auto at = [&](int k) { return base[std::size_t{index.lane[k]} * Stride]; };
  return {{Double2{at(0), at(1)}, Double2{at(2), at(3)}}};
}
// p[2 lane + k] in lane of out[k].
inline void load_pairs(const double* p, Raw* out) {
  for (int k = 0; k < 2; ++k) out[k] = {{Double2{p[k], p[2 + k]}, Double2{p[4 + k], p[6 + k]}}};
}

// columns[c * lanes + lane] = row[lane][c]
inline void transpose(const std::uint32_t* const* row, std::uint32_t* columns) {
  for (int lane = 0; lane < lanes; ++lane)
    for (int c = 0; c < lanes; ++c) columns[c * lanes + lane] = row[lane][c];
}

template <int N, int Stride>
inline void gather_tuple(const double* base, const std::uint32_t* j, Raw* out) {
  for (int k = 0; k < N; ++k) out[k] = gather<Stride>(base + k, load_index(j));
}

// For pack_math.hpp. 2^n, where `shifted` is the whole number n (-1022 <= n <= 1023) plus 1.5 * 2^52.
inline Raw power_of_two(Raw shifted) {
  Raw power;
  for (int k = 0; k < 2; ++k)
    power.half[k] =
        bits_to_double(add_bits(bits_to_long(shifted.half[k]) << 52, bits_to_long(Double2{1.0, 1.0})));
  return power;
}
// x = mantissa * 2^n with sqrt(1/2) <= mantissa < sqrt(2), for normal x > 0; returns n.
inline Raw split_exponent(Raw x, Raw& mantissa) {
  const Long2 one = bits_to_long(Double2{1.0, 1.0});
  const Long2 root = bits_to_long(Double2{0.70710678118654752, 0.70710678118654752});
  const Double2 shift = {0x1.8p52, 0x1.8p52};
  Raw n;
  for (int k = 0; k < 2; ++k) {
    const Long2 bits = bits_to_long(x.half[k]);
    const Long2 biased = add_bits(subtract_bits(bits, root), one) >> 52;
    mantissa.half[k] = bits_to_double(add_bits(subtract_bits(bits, biased << 52), one));
    n.half[k] = bits_to_double(biased + bits_to_long(shift)) - (shift + 1023.0);
  }
  return n;
}
inline constexpr bool fast_scale = false;
inline Raw scale(Raw a, Raw) { return a; }

#endif

}  // namespace simd
}  // namespace SHOAL_ISA_NAMESPACE
}  // namespace shoal
