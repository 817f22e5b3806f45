// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// SinglePack: twice as many numbers as a Pack, in single precision. Code that is generic over a real type runs with it
// too: numbers in double precision that meet one are rounded to single. Sums over its lanes are double.
#pragma once

#include <cmath>
#include <cstdint>

#include "shoal/detail/single_backend.hpp"
#include "shoal/pack.hpp"

namespace shoal {
inline namespace SHOAL_ISA_NAMESPACE {

/// Number of floats in a SinglePack.
inline constexpr int single_lanes = simd::single::lanes;

/// One truth value per lane: the result of comparing single packs.
struct SingleMask {
  simd::single::RawMask v;

  SingleMask() = default;
  SingleMask(bool b) : v(simd::single::mask_all(b)) {}  // NOLINT: a bool is the same truth in every lane
  static SingleMask from_raw(simd::single::RawMask raw) {
    SingleMask m;
    m.v = raw;
    return m;
  }

  bool operator[](int lane) const { return simd::single::mask_lane(v, lane); }

  friend SingleMask operator&(SingleMask a, SingleMask b) {
    return from_raw(simd::single::mask_and(a.v, b.v));
  }
  friend SingleMask operator|(SingleMask a, SingleMask b) {
    return from_raw(simd::single::mask_or(a.v, b.v));
  }
  friend SingleMask operator&&(SingleMask a, SingleMask b) { return a & b; }
  friend SingleMask operator||(SingleMask a, SingleMask b) { return a | b; }
  friend SingleMask operator!(SingleMask a) { return from_raw(simd::single::mask_not(a.v)); }
  friend bool any(SingleMask a) { return simd::single::mask_any(a.v); }
  friend bool none(SingleMask a) { return !any(a); }
  friend bool all(SingleMask a) { return none(!a); }
};

/// `single_lanes` floats. Arithmetic is IEEE arithmetic of each lane in single precision.
struct SinglePack {
  simd::single::Raw v;

  SinglePack() = default;
  SinglePack(double x)  // NOLINT: a number is the same number in every lane
      : v(simd::single::broadcast(static_cast<float>(x))) {}
  static SinglePack from_raw(simd::single::Raw raw) {
    SinglePack p;
    p.v = raw;
    return p;
  }
  /// Reads `single_lanes` floats; no alignment is needed.
  static SinglePack load(const float* p) { return from_raw(simd::single::load(p)); }
  void store(float* p) const { simd::single::store(p, v); }
  /// The lanes of two packs, rounded to the nearest, and back.
  static SinglePack join(Pack low, Pack high) { return from_raw(simd::single::join(low.v, high.v)); }
  Pack low() const { return Pack::from_raw(simd::single::low(v)); }
  Pack high() const { return Pack::from_raw(simd::single::high(v)); }

  double operator[](int lane) const { return lane < lanes ? low()[lane] : high()[lane - lanes]; }

  SinglePack& operator+=(SinglePack b) { return *this = *this + b; }
  SinglePack& operator-=(SinglePack b) { return *this = *this - b; }
  SinglePack& operator*=(SinglePack b) { return *this = *this * b; }
  SinglePack& operator/=(SinglePack b) { return *this = *this / b; }

  friend SinglePack operator+(SinglePack a) { return a; }
  friend SinglePack operator-(SinglePack a) { return from_raw(-a.v); }
  friend SinglePack operator+(SinglePack a, SinglePack b) { return from_raw(a.v + b.v); }
  friend SinglePack operator-(SinglePack a, SinglePack b) { return from_raw(a.v - b.v); }
  friend SinglePack operator*(SinglePack a, SinglePack b) { return from_raw(a.v * b.v); }
  friend SinglePack operator/(SinglePack a, SinglePack b) { return from_raw(a.v / b.v); }

  friend SingleMask operator<(SinglePack a, SinglePack b) {
    return SingleMask::from_raw(simd::single::less(a.v, b.v));
  }
  friend SingleMask operator<=(SinglePack a, SinglePack b) {
    return SingleMask::from_raw(simd::single::less_equal(a.v, b.v));
  }
  friend SingleMask operator>(SinglePack a, SinglePack b) { return b < a; }
  friend SingleMask operator>=(SinglePack a, SinglePack b) { return b <= a; }
  friend SingleMask operator==(SinglePack a, SinglePack b) {
    return SingleMask::from_raw(simd::single::equal(a.v, b.v));
  }
  friend SingleMask operator!=(SinglePack a, SinglePack b) { return !(a == b); }

  /// a where the mask is set, b elsewhere.
  friend SinglePack select(SingleMask m, SinglePack a, SinglePack b) {
    return from_raw(simd::single::select(m.v, a.v, b.v));
  }
  /// The second argument where the two are unordered, as of Pack.
  friend SinglePack min(SinglePack a, SinglePack b) { return from_raw(simd::single::min(a.v, b.v)); }
  friend SinglePack max(SinglePack a, SinglePack b) { return from_raw(simd::single::max(a.v, b.v)); }
  friend SinglePack abs(SinglePack a) { return from_raw(simd::single::abs(a.v)); }
  friend SinglePack sqrt(SinglePack a) { return from_raw(simd::single::sqrt(a.v)); }
  /// 1 / sqrt(a) for positive normal a and 1 / a for normal a, within 2 units in the last place.
  friend SinglePack inverse_sqrt(SinglePack a) { return from_raw(simd::single::inverse_sqrt(a.v)); }
  friend SinglePack reciprocal(SinglePack a) { return from_raw(simd::single::reciprocal(a.v)); }
  /// The C library's, lane by lane.
  friend SinglePack exp(SinglePack a) { return join(exp(a.low()), exp(a.high())); }

  /// Sum of all lanes, in double precision and in one fixed order.
  friend double horizontal_sum(SinglePack a) { return horizontal_sum(a.low() + a.high()); }
};

/// One 32-bit index per lane: views of the indices of the lower and of the upper half of the lanes.
struct SingleIndexPack {
  const std::uint32_t *low, *high;

  std::uint32_t operator[](int k) const { return k < lanes ? low[k] : high[k - lanes]; }
};

/// base[index * Stride + k], k = 0 ... 3, in each lane.
template <int Stride>
inline void gather_four(const float* base, SingleIndexPack index, SinglePack* out) {
  simd::single::Raw raw[4];
  simd::single::gather_four<Stride>(base, index.low, index.high, raw);
  for (int k = 0; k < 4; ++k) out[k] = SinglePack::from_raw(raw[k]);
}

/// base[index * N + k], k = 0 ... N - 1, rounded. May read one number behind the last one asked for, as of Pack.
template <int N>
inline void gather_tuple(const double* base, SingleIndexPack index, SinglePack* out) {
  Pack low[N], high[N];
  gather_tuple<N>(base, IndexPack{index.low}, low);
  gather_tuple<N>(base, IndexPack{index.high}, high);
  for (int k = 0; k < N; ++k) out[k] = SinglePack::join(low[k], high[k]);
}

/// The sums over all lanes of N packs, together in a third of the time: of four neighbouring lanes in single precision, of
/// these in double precision, in one fixed order.
template <int N>
inline void horizontal_sums(const SinglePack* packs, double* out) {
  for (int first = 0; first < N; first += 4) {
    simd::single::Raw four[4];
    double sums[4];
    for (int k = 0; k < 4; ++k) four[k] = (first + k < N ? packs[first + k] : SinglePack(0.0)).v;
    simd::single::sum_of_four(four, sums);
    for (int k = 0; k < 4 && first + k < N; ++k) out[first + k] = sums[k];
  }
}

/// Lanes 0 ... n - 1 (none if n <= 0, all if n >= single_lanes).
inline SingleMask first_single_lanes(std::int64_t n) {
  return SingleMask::from_raw(simd::single::first_lanes(n));
}

template <>
struct RealTraits<SinglePack> {
  using MaskType = SingleMask;
  using IndexType = SingleIndexPack;
  static constexpr int lanes = single_lanes;
};

}  // namespace SHOAL_ISA_NAMESPACE
}  // namespace shoal
