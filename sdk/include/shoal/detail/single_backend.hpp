// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The part of SinglePack that differs between instruction sets, as pack_backend.hpp is for Pack. A single pack has twice
// as many lanes. Included by single_pack.hpp only.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "shoal/pack.hpp"

namespace shoal {
inline namespace SHOAL_ISA_NAMESPACE {
namespace simd::single {

inline constexpr int lanes = 2 * simd::lanes;

#if defined(__AVX512F__)

using Raw = __m512;
using RawMask = __mmask16;
inline constexpr __mmask16 full_mask = 0xFFFF;

inline Raw broadcast(float x) { return _mm512_set1_ps(x); }
inline Raw load(const float* p) { return _mm512_loadu_ps(p); }
inline void store(float* p, Raw a) { _mm512_storeu_ps(p, a); }
inline Raw join(simd::Raw low, simd::Raw high) {
  return __builtin_shufflevector(_mm512_maskz_cvtpd_ps(0xFF, low), _mm512_maskz_cvtpd_ps(0xFF, high), 0, 1, 2,
                                 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}
inline simd::Raw low(Raw a) {
  return _mm512_maskz_cvtps_pd(0xFF, __builtin_shufflevector(a, a, 0, 1, 2, 3, 4, 5, 6, 7));
}
inline simd::Raw high(Raw a) {
  return _mm512_maskz_cvtps_pd(0xFF, __builtin_shufflevector(a, a, 8, 9, 10, 11, 12, 13, 14, 15));
}
inline RawMask less(Raw a, Raw b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
inline RawMask less_equal(Raw a, Raw b) { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
inline RawMask equal(Raw a, Raw b) { return _mm512_cmp_ps_mask(a, b, _CMP_EQ_OQ); }
inline Raw select(RawMask m, Raw a, Raw b) { return _mm512_mask_blend_ps(m, b, a); }
inline Raw min(Raw a, Raw b) { return _mm512_maskz_min_ps(full_mask, a, b); }
inline Raw max(Raw a, Raw b) { return _mm512_maskz_max_ps(full_mask, a, b); }
inline Raw sqrt(Raw a) { return _mm512_maskz_sqrt_ps(full_mask, a); }
inline Raw inverse_sqrt(Raw a) {  // from 14 bits by one step of Newton's rule
  const Raw half = broadcast(0.5f);
  const Raw y = _mm512_maskz_rsqrt14_ps(full_mask, a);
  return _mm512_fmadd_ps(y, _mm512_fnmadd_ps(half * a * y, y, half), y);
}
inline Raw reciprocal(Raw a) {
  const Raw y = _mm512_maskz_rcp14_ps(full_mask, a);
  return _mm512_fmadd_ps(y, _mm512_fnmadd_ps(a, y, broadcast(1.0f)), y);
}
inline Raw abs(Raw a) {
  return _mm512_castsi512_ps(_mm512_and_si512(_mm512_castps_si512(a), _mm512_set1_epi32(0x7FFFFFFF)));
}
inline RawMask mask_all(bool b) { return b ? full_mask : RawMask{0}; }
inline RawMask mask_and(RawMask a, RawMask b) { return static_cast<RawMask>(a & b); }
inline RawMask mask_or(RawMask a, RawMask b) { return static_cast<RawMask>(a | b); }
inline RawMask mask_not(RawMask a) { return static_cast<RawMask>(a ^ full_mask); }
inline bool mask_any(RawMask a) { return a != 0; }
inline bool mask_lane(RawMask a, int k) { return ((a >> k) & 1) != 0; }
inline RawMask first_lanes(std::int64_t n) {
  return static_cast<RawMask>(
      _bzhi_u32(full_mask, static_cast<unsigned>(std::clamp<std::int64_t>(n, 0, lanes))));
}
// a - b of whole numbers of 32 bits that the packs hold, modulo 2^32, as single-precision numbers.
typedef std::uint32_t Words __attribute__((vector_size(64)));
inline Raw difference(Raw a, Raw b) {
  const Words d = reinterpret_cast<Words>(a) - reinterpret_cast<Words>(b);
  return _mm512_maskz_cvtepi32_ps(full_mask, reinterpret_cast<__m512i>(d));
}

// Four numbers of each lane, at base + index * Stride.
template <int Stride>
inline void gather_four(const float* base, const std::uint32_t* first, const std::uint32_t* second,
                        Raw* out) {
  const auto at = [&](const std::uint32_t* j, int lane) {
    return _mm_loadu_ps(base + std::size_t{j[lane]} * Stride);
  };
  const auto four = [&](int a) {
    Raw r = _mm512_zextps128_ps512(at(first, a));
    r = _mm512_mask_broadcast_f32x4(r, 0x00F0, at(first, 4 + a));
    r = _mm512_mask_broadcast_f32x4(r, 0x0F00, at(second, a));
    return _mm512_mask_broadcast_f32x4(r, 0xF000, at(second, 4 + a));
  };
  const Raw a = four(0), b = four(1), c = four(2), d = four(3);
  const __m512d ab01 = _mm512_castps_pd(_mm512_maskz_unpacklo_ps(full_mask, a, b));
  const __m512d ab23 = _mm512_castps_pd(_mm512_maskz_unpackhi_ps(full_mask, a, b));
  const __m512d cd01 = _mm512_castps_pd(_mm512_maskz_unpacklo_ps(full_mask, c, d));
  const __m512d cd23 = _mm512_castps_pd(_mm512_maskz_unpackhi_ps(full_mask, c, d));
  out[0] = _mm512_castpd_ps(_mm512_maskz_unpacklo_pd(0xFF, ab01, cd01));
  out[1] = _mm512_castpd_ps(_mm512_maskz_unpackhi_pd(0xFF, ab01, cd01));
  out[2] = _mm512_castpd_ps(_mm512_maskz_unpacklo_pd(0xFF, ab23, cd23));
  out[3] = _mm512_castpd_ps(_mm512_maskz_unpackhi_pd(0xFF, ab23, cd23));
}

// The sums over the lanes of four packs: over four neighbouring lanes, (0 + 2) + (1 + 3), in single precision, over what
// is left in double precision.
inline void sum_of_four(const Raw* four, double* out) {
  const Raw ab = _mm512_maskz_unpacklo_ps(full_mask, four[0], four[1]) +
                 _mm512_maskz_unpackhi_ps(full_mask, four[0], four[1]);
  const Raw cd = _mm512_maskz_unpacklo_ps(full_mask, four[2], four[3]) +
                 _mm512_maskz_unpackhi_ps(full_mask, four[2], four[3]);
  const __m512d x = _mm512_castps_pd(ab), y = _mm512_castps_pd(cd);
  const Raw abcd = _mm512_castpd_ps(_mm512_maskz_unpacklo_pd(0xFF, x, y)) +
                   _mm512_castpd_ps(_mm512_maskz_unpackhi_pd(0xFF, x, y));
  const __m512d halves = low(abcd) + high(abcd);
  _mm256_storeu_pd(out, __builtin_shufflevector(halves, halves, 0, 1, 2, 3) +
                            __builtin_shufflevector(halves, halves, 4, 5, 6, 7));
}

#elif defined(__AVX__)

using Raw = __m256;
using RawMask = __m256;  // all bits of a lane set or none

inline Raw broadcast(float x) { return _mm256_set1_ps(x); }
inline Raw load(const float* p) { return _mm256_loadu_ps(p); }
inline void store(float* p, Raw a) { _mm256_storeu_ps(p, a); }
inline Raw join(simd::Raw low, simd::Raw high) {
  return __builtin_shufflevector(_mm256_cvtpd_ps(low), _mm256_cvtpd_ps(high), 0, 1, 2, 3, 4, 5, 6, 7);
}
inline simd::Raw low(Raw a) { return _mm256_cvtps_pd(_mm256_castps256_ps128(a)); }
inline simd::Raw high(Raw a) { return _mm256_cvtps_pd(_mm256_extractf128_ps(a, 1)); }
inline RawMask less(Raw a, Raw b) { return _mm256_cmp_ps(a, b, _CMP_LT_OQ); }
inline RawMask less_equal(Raw a, Raw b) { return _mm256_cmp_ps(a, b, _CMP_LE_OQ); }
inline RawMask equal(Raw a, Raw b) { return _mm256_cmp_ps(a, b, _CMP_EQ_OQ); }
inline Raw select(RawMask m, Raw a, Raw b) { return _mm256_blendv_ps(b, a, m); }
inline Raw min(Raw a, Raw b) { return _mm256_min_ps(a, b); }
inline Raw max(Raw a, Raw b) { return _mm256_max_ps(a, b); }
inline Raw sqrt(Raw a) { return _mm256_sqrt_ps(a); }
inline Raw inverse_sqrt(Raw a) { return broadcast(1.0f) / sqrt(a); }
inline Raw reciprocal(Raw a) { return broadcast(1.0f) / a; }
inline Raw abs(Raw a) { return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), a); }
inline RawMask mask_all(bool b) { return _mm256_castsi256_ps(_mm256_set1_epi32(b ? -1 : 0)); }
inline RawMask mask_and(RawMask a, RawMask b) { return _mm256_and_ps(a, b); }
inline RawMask mask_or(RawMask a, RawMask b) { return _mm256_or_ps(a, b); }
inline RawMask mask_not(RawMask a) { return _mm256_xor_ps(a, mask_all(true)); }
inline bool mask_any(RawMask a) { return _mm256_movemask_ps(a) != 0; }
inline bool mask_lane(RawMask a, int k) { return ((_mm256_movemask_ps(a) >> k) & 1) != 0; }
inline RawMask first_lanes(std::int64_t n) {
  return less(_mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7), broadcast(static_cast<float>(n)));
}
inline Raw difference(Raw a, Raw b) {
  typedef std::uint32_t Words __attribute__((vector_size(16)));
  const auto half = [](__m128 x, __m128 y) {
    const Words d = reinterpret_cast<Words>(x) - reinterpret_cast<Words>(y);
    return _mm_cvtepi32_ps(reinterpret_cast<__m128i>(d));
  };
  const __m128 l = half(_mm256_castps256_ps128(a), _mm256_castps256_ps128(b));
  const __m128 h = half(_mm256_extractf128_ps(a, 1), _mm256_extractf128_ps(b, 1));
  return __builtin_shufflevector(l, h, 0, 1, 2, 3, 4, 5, 6, 7);
}

template <int Stride>
inline void gather_four(const float* base, const std::uint32_t* first, const std::uint32_t* second,
                        Raw* out) {
  const auto two = [&](int a) {
    return __builtin_shufflevector(_mm_loadu_ps(base + std::size_t{first[a]} * Stride),
                                   _mm_loadu_ps(base + std::size_t{second[a]} * Stride), 0, 1, 2, 3, 4, 5, 6,
                                   7);
  };
  const Raw a = two(0), b = two(1), c = two(2), d = two(3);
  const __m256d ab01 = _mm256_castps_pd(_mm256_unpacklo_ps(a, b));
  const __m256d ab23 = _mm256_castps_pd(_mm256_unpackhi_ps(a, b));
  const __m256d cd01 = _mm256_castps_pd(_mm256_unpacklo_ps(c, d));
  const __m256d cd23 = _mm256_castps_pd(_mm256_unpackhi_ps(c, d));
  out[0] = _mm256_castpd_ps(_mm256_unpacklo_pd(ab01, cd01));
  out[1] = _mm256_castpd_ps(_mm256_unpackhi_pd(ab01, cd01));
  out[2] = _mm256_castpd_ps(_mm256_unpacklo_pd(ab23, cd23));
  out[3] = _mm256_castpd_ps(_mm256_unpackhi_pd(ab23, cd23));
}

inline void sum_of_four(const Raw* four, double* out) {
  const Raw ab = _mm256_unpacklo_ps(four[0], four[1]) + _mm256_unpackhi_ps(four[0], four[1]);
  const Raw cd = _mm256_unpacklo_ps(four[2], four[3]) + _mm256_unpackhi_ps(four[2], four[3]);
  const __m256d x = _mm256_castps_pd(ab), y = _mm256_castps_pd(cd);
  const Raw abcd = _mm256_castpd_ps(_mm256_unpacklo_pd(x, y)) + _mm256_castpd_ps(_mm256_unpackhi_pd(x, y));
  _mm256_storeu_pd(out, low(abcd) + high(abcd));
}

#else  // two vectors of 16 bytes, as in pack_backend.hpp

typedef float Float4 __attribute__((vector_size(16)));
typedef std::int32_t Int4 __attribute__((vector_size(16)));
typedef std::uint32_t Words __attribute__((vector_size(16)));

struct Raw {
  Float4 half[2];

  friend Raw operator-(Raw a) { return {{-a.half[0], -a.half[1]}}; }
  friend Raw operator+(Raw a, Raw b) { return {{a.half[0] + b.half[0], a.half[1] + b.half[1]}}; }
  friend Raw operator-(Raw a, Raw b) { return {{a.half[0] - b.half[0], a.half[1] - b.half[1]}}; }
  friend Raw operator*(Raw a, Raw b) { return {{a.half[0] * b.half[0], a.half[1] * b.half[1]}}; }
  friend Raw operator/(Raw a, Raw b) { return {{a.half[0] / b.half[0], a.half[1] / b.half[1]}}; }
};
struct RawMask {
  Int4 half[2];
};

inline float get(Raw a, int k) { return a.half[k / 4][k % 4]; }
inline void set(Raw& a, int k, float x) { a.half[k / 4][k % 4] = x; }
template <class F>
inline Raw each(F&& f) {
  Raw a;
  for (int k = 0; k < lanes; ++k) set(a, k, f(k));
  return a;
}
inline Float4 select_half(Int4 m, Float4 a, Float4 b) {
  return reinterpret_cast<Float4>((m & reinterpret_cast<Int4>(a)) | (~m & reinterpret_cast<Int4>(b)));
}

inline Raw broadcast(float x) { return {{Float4{x, x, x, x}, Float4{x, x, x, x}}}; }
inline Raw load(const float* p) {
  return each([&](int k) { return p[k]; });
}
inline void store(float* p, Raw a) {
  for (int k = 0; k < lanes; ++k) p[k] = get(a, k);
}
inline Raw join(simd::Raw low, simd::Raw high) {
  return each([&](int k) {
    return static_cast<float>(k < simd::lanes ? get_lane(low, k) : get_lane(high, k - simd::lanes));
  });
}
inline simd::Raw low(Raw a) {
  return {{simd::Double2{get(a, 0), get(a, 1)}, simd::Double2{get(a, 2), get(a, 3)}}};
}
inline simd::Raw high(Raw a) {
  return {{simd::Double2{get(a, 4), get(a, 5)}, simd::Double2{get(a, 6), get(a, 7)}}};
}
inline RawMask less(Raw a, Raw b) { return {{Int4(a.half[0] < b.half[0]), Int4(a.half[1] < b.half[1])}}; }
inline RawMask less_equal(Raw a, Raw b) {
  return {{Int4(a.half[0] <= b.half[0]), Int4(a.half[1] <= b.half[1])}};
}
inline RawMask equal(Raw a, Raw b) { return {{Int4(a.half[0] == b.half[0]), Int4(a.half[1] == b.half[1])}}; }
inline Raw select(RawMask m, Raw a, Raw b) {
  return {{select_half(m.half[0], a.half[0], b.half[0]), select_half(m.half[1], a.half[1], b.half[1])}};
}
inline Raw min(Raw a, Raw b) { return select(less(a, b), a, b); }
inline Raw max(Raw a, Raw b) { return select(less(b, a), a, b); }
inline Raw sqrt(Raw a) {
  return each([&](int k) { return std::sqrt(get(a, k)); });
}
inline Raw inverse_sqrt(Raw a) { return broadcast(1.0f) / sqrt(a); }
inline Raw reciprocal(Raw a) { return broadcast(1.0f) / a; }
inline Raw abs(Raw a) {
  return each([&](int k) { return std::fabs(get(a, k)); });
}
inline RawMask mask_all(bool b) {
  const std::int32_t x = b ? -1 : 0;
  return {{Int4{x, x, x, x}, Int4{x, x, x, x}}};
}
inline RawMask mask_and(RawMask a, RawMask b) { return {{a.half[0] & b.half[0], a.half[1] & b.half[1]}}; }
inline RawMask mask_or(RawMask a, RawMask b) { return {{a.half[0] | b.half[0], a.half[1] | b.half[1]}}; }
inline RawMask mask_not(RawMask a) { return {{~a.half[0], ~a.half[1]}}; }
inline bool mask_lane(RawMask a, int k) { return a.half[k / 4][k % 4] != 0; }
inline bool mask_any(RawMask a) {
  for (int k = 0; k < lanes; ++k)
    if (mask_lane(a, k)) return true;
  return false;
}
inline RawMask first_lanes(std::int64_t n) {
  RawMask m;
  for (int k = 0; k < lanes; ++k) m.half[k / 4][k % 4] = k < n ? -1 : 0;
  return m;
}
inline Raw difference(Raw a, Raw b) {
  Raw d;
  for (int k = 0; k < 2; ++k) {
    const Int4 whole =
        reinterpret_cast<Int4>(reinterpret_cast<Words>(a.half[k]) - reinterpret_cast<Words>(b.half[k]));
    d.half[k] = __builtin_convertvector(whole, Float4);
  }
  return d;
}

template <int Stride>
inline void gather_four(const float* base, const std::uint32_t* first, const std::uint32_t* second,
                        Raw* out) {
  for (int c = 0; c < 4; ++c)
    out[c] = each([&](int k) {
      const std::uint32_t j = k < lanes / 2 ? first[k] : second[k - lanes / 2];
      return base[std::size_t{j} * Stride + static_cast<std::size_t>(c)];
    });
}

inline void sum_of_four(const Raw* four, double* out) {
  for (int k = 0; k < 4; ++k) {
    const auto half = [&](int h) {
      const Float4 x = four[k].half[h];
      return static_cast<double>((x[0] + x[2]) + (x[1] + x[3]));
    };
    out[k] = half(0) + half(1);
  }
}

#endif

}  // namespace simd::single
}  // namespace SHOAL_ISA_NAMESPACE
}  // namespace shoal
