// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Pack: a fixed number of doubles that behave like one, so that pair code is written once and runs as SIMD.
//
// Code that is generic over a real type R runs with R = double and R = Pack; the functions below exist for both.
// Branches on data become select(). A comparison of packs gives a Mask, of doubles a bool.
//
// Three widths of hardware: AVX-512 (8 lanes), AVX and AVX2 (4 lanes), anything else (4 lanes as two vectors of
// 16 bytes). Everything that depends on it, and all inline SDK code built on it, stands in an inline namespace
// with the name of the instruction set: objects compiled with different -march then never share a symbol.
// std::experimental::simd is not used because clang 14 with libstdc++ 12 drops its masked assignments.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#if defined(__AVX__)
#include <immintrin.h>
#endif

#if defined(__AVX512F__)
#define SHOAL_ISA_NAMESPACE isa_avx512
#elif defined(__AVX2__)
#define SHOAL_ISA_NAMESPACE isa_avx2
#elif defined(__AVX__)
#define SHOAL_ISA_NAMESPACE isa_avx
#else
#define SHOAL_ISA_NAMESPACE isa_generic
#endif

#include "shoal/detail/pack_backend.hpp"

namespace shoal {
inline namespace SHOAL_ISA_NAMESPACE {

/// Number of doubles in a Pack.
inline constexpr int lanes = simd::lanes;

/// One truth value per lane: the result of comparing packs.
struct Mask {
  simd::RawMask v;

  Mask() = default;
  Mask(bool b) : v(simd::mask_all(b)) {}  // NOLINT: a bool is the same truth in every lane
  static Mask from_raw(simd::RawMask raw) {
    Mask m;
    m.v = raw;
    return m;
  }

  bool operator[](int lane) const { return simd::mask_lane(v, lane); }

  friend Mask operator&(Mask a, Mask b) { return from_raw(simd::mask_and(a.v, b.v)); }
  friend Mask operator|(Mask a, Mask b) { return from_raw(simd::mask_or(a.v, b.v)); }
  friend Mask operator&&(Mask a, Mask b) { return a & b; }
  friend Mask operator||(Mask a, Mask b) { return a | b; }
  friend Mask operator!(Mask a) { return from_raw(simd::mask_not(a.v)); }
};

/// `lanes` doubles. Arithmetic is strict IEEE arithmetic of each lane.
struct Pack {
  simd::Raw v;

  Pack() = default;
  Pack(double x) : v(simd::broadcast(x)) {}  // NOLINT: a number is the same number in every lane
  static Pack from_raw(simd::Raw raw) {
    Pack p;
    p.v = raw;
    return p;
  }
  /// Reads `lanes` doubles; no alignment is needed.
  static Pack load(const double* p) { return from_raw(simd::load(p)); }
  void store(double* p) const { simd::store(p, v); }
  /// The same in single precision, rounded to the nearest.
  static Pack load(const float* p) { return from_raw(simd::load(p)); }
  void store(float* p) const { simd::store(p, v); }
  /// f(0), f(1), ... in the lanes.
  template <class F>
  static Pack from(F&& f) {
    alignas(64) double x[simd::lanes];
    for (int k = 0; k < simd::lanes; ++k) x[k] = f(k);
    return load(x);
  }

  double operator[](int lane) const { return simd::get_lane(v, lane); }
  void set(int lane, double x) { simd::set_lane(v, lane, x); }

  Pack& operator+=(Pack b) { return *this = *this + b; }
  Pack& operator-=(Pack b) { return *this = *this - b; }
  Pack& operator*=(Pack b) { return *this = *this * b; }
  Pack& operator/=(Pack b) { return *this = *this / b; }

  friend Pack operator+(Pack a) { return a; }
  friend Pack operator-(Pack a) { return from_raw(-a.v); }
  friend Pack operator+(Pack a, Pack b) { return from_raw(a.v + b.v); }
  friend Pack operator-(Pack a, Pack b) { return from_raw(a.v - b.v); }
  friend Pack operator*(Pack a, Pack b) { return from_raw(a.v * b.v); }
  friend Pack operator/(Pack a, Pack b) { return from_raw(a.v / b.v); }

  friend Mask operator<(Pack a, Pack b) { return Mask::from_raw(simd::less(a.v, b.v)); }
  friend Mask operator<=(Pack a, Pack b) { return Mask::from_raw(simd::less_equal(a.v, b.v)); }
  friend Mask operator>(Pack a, Pack b) { return Mask::from_raw(simd::less(b.v, a.v)); }
  friend Mask operator>=(Pack a, Pack b) { return Mask::from_raw(simd::less_equal(b.v, a.v)); }
  friend Mask operator==(Pack a, Pack b) { return Mask::from_raw(simd::equal(a.v, b.v)); }
  friend Mask operator!=(Pack a, Pack b) { return !(a == b); }

  /// a where the mask is set, b elsewhere.
  friend Pack select(Mask m, Pack a, Pack b) { return from_raw(simd::select(m.v, a.v, b.v)); }
  /// The second argument where the two are unordered: min(limit, x) and max(limit, x) let a NaN in x through.
  friend Pack min(Pack a, Pack b) { return from_raw(simd::min(a.v, b.v)); }
  friend Pack max(Pack a, Pack b) { return from_raw(simd::max(a.v, b.v)); }
  friend Pack abs(Pack a) { return from_raw(simd::abs(a.v)); }
  friend Pack sqrt(Pack a) { return from_raw(simd::sqrt(a.v)); }
  /// 1 / sqrt(a) for positive normal a, within 2 units in the last place.
  friend Pack inverse_sqrt(Pack a) { return from_raw(simd::inverse_sqrt(a.v)); }
  /// 1 / a for normal a, within 2 units in the last place and at a third of a division's cost.
  friend Pack reciprocal(Pack a) { return from_raw(simd::reciprocal(a.v)); }

  /// Sum of all lanes in one fixed order: the upper half is added to the lower half until one lane is left,
  /// ((0+4)+(2+6)) + ((1+5)+(3+7)) for 8 lanes, (0+2)+(1+3) for 4.
  friend double horizontal_sum(Pack a) { return simd::sum(a.v); }
  /// Smallest and largest lane.
  friend double horizontal_min(Pack a) {
    double x = a[0];
    for (int k = 1; k < simd::lanes; ++k) x = a[k] < x ? a[k] : x;
    return x;
  }
  friend double horizontal_max(Pack a) {
    double x = a[0];
    for (int k = 1; k < simd::lanes; ++k) x = a[k] > x ? a[k] : x;
    return x;
  }

  // These call the C library once per lane: about `lanes` times the cost of one call. pack_math.hpp has fast_exp and
  // fast_log, which do not.
  friend Pack exp(Pack a) {
    return a.each([](double x) { return std::exp(x); });
  }
  friend Pack log(Pack a) {
    return a.each([](double x) { return std::log(x); });
  }
  friend Pack pow(Pack a, Pack b) {
    Pack r;
    for (int k = 0; k < simd::lanes; ++k) r.set(k, std::pow(a[k], b[k]));
    return r;
  }

  /// Applies a scalar function to each lane; for what has no SIMD form.
  template <class F>
  Pack each(F&& f) const {
    double x[simd::lanes];
    store(x);
    for (double& lane : x) lane = f(lane);
    return load(x);
  }
};

/// One 32-bit index per lane: a view of `lanes` indices in memory, which must live as long.
struct IndexPack {
  const std::uint32_t* lane;

  /// No alignment is needed.
  static IndexPack load(const std::uint32_t* p) { return {p}; }
  std::uint32_t operator[](int k) const { return lane[k]; }
};

/// base[index * Stride + Component] in each lane. index * Stride must stay below 2^31.
template <int Stride = 1, int Component = 0>
inline Pack gather(const double* base, IndexPack index) {
  return Pack::from_raw(simd::gather<Stride>(base + Component, simd::load_index(index.lane)));
}

/// base[index * Stride + k], k = 0 ... N - 1, in each lane. May read one number behind the last one asked for, so the
/// array must be longer by one (all fields are, see SHOAL_PADDING).
template <int N, int Stride = N>
inline void gather_tuple(const double* base, IndexPack index, Pack* out) {
  if constexpr (N == 1) {
    out[0] = gather<Stride>(base, index);
  } else {
    constexpr int n = N < 4 ? N : 4;
    simd::Raw raw[n];
    simd::gather_tuple<n, Stride>(base, index.lane, raw);
    for (int k = 0; k < n; ++k) out[k] = Pack::from_raw(raw[k]);
    if constexpr (N > n) gather_tuple<N - n, Stride>(base + n, index, out + n);
  }
}

/// p[lane * N + k], k = 0 ... N - 1, in each lane: numbers that follow one another. May read one number behind the last.
template <int N>
inline void load_tuple(const double* p, Pack* out) {
  if constexpr (N == 1) {
    out[0] = Pack::load(p);
  } else if constexpr (N == 2) {
    simd::Raw raw[2];
    simd::load_pairs(p, raw);
    for (int k = 0; k < 2; ++k) out[k] = Pack::from_raw(raw[k]);
  } else {
    static constexpr std::uint32_t one_after_another[] = {0, 1, 2, 3, 4, 5, 6, 7};
    gather_tuple<N>(p, IndexPack{one_after_another}, out);
  }
}

/// Lanes 0 ... n-1 (none if n <= 0, all if n >= lanes).
inline Mask first_lanes(std::int64_t n) { return Mask::from_raw(simd::first_lanes(n)); }

inline bool any(Mask m) { return simd::mask_any(m.v); }
inline bool none(Mask m) { return !simd::mask_any(m.v); }
inline bool all(Mask m) { return !simd::mask_any(simd::mask_not(m.v)); }

// The same functions for plain numbers, with the same treatment of NaN and signed zero.
inline constexpr double select(bool m, double a, double b) { return m ? a : b; }
inline constexpr double min(double a, double b) { return a < b ? a : b; }
inline constexpr double max(double a, double b) { return a > b ? a : b; }
inline double abs(double a) { return std::fabs(a); }
inline double sqrt(double a) { return std::sqrt(a); }
inline double inverse_sqrt(double a) { return 1.0 / std::sqrt(a); }
inline double reciprocal(double a) { return 1.0 / a; }
inline double exp(double a) { return std::exp(a); }
inline double log(double a) { return std::log(a); }
inline double pow(double a, double b) { return std::pow(a, b); }
inline constexpr double horizontal_sum(double a) { return a; }
inline constexpr double horizontal_min(double a) { return a; }
inline constexpr double horizontal_max(double a) { return a; }
inline constexpr bool any(bool m) { return m; }
inline constexpr bool none(bool m) { return !m; }
inline constexpr bool all(bool m) { return m; }

template <int Stride = 1, int Component = 0>
inline double gather(const double* base, std::size_t index) {
  return base[index * Stride + Component];
}
template <int N, int Stride = N>
inline void gather_tuple(const double* base, std::size_t index, double* out) {
  for (int k = 0; k < N; ++k) out[k] = base[index * Stride + std::size_t(k)];
}

/// What a generic function needs to know of its real type: how many numbers it holds, its truth type, its index.
template <class R>
struct RealTraits;
template <>
struct RealTraits<double> {
  using MaskType = bool;
  using IndexType = std::size_t;
  static constexpr int lanes = 1;
};
template <>
struct RealTraits<Pack> {
  using MaskType = Mask;
  using IndexType = IndexPack;
  static constexpr int lanes = simd::lanes;
};

/// double or Pack.
template <class R>
concept Real = requires {
  RealTraits<R>::lanes;
};

}  // namespace SHOAL_ISA_NAMESPACE
}  // namespace shoal
