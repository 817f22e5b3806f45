// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Exponentials and logarithms that run in all lanes of a Pack at once; the exp and log of pack.hpp call the C library
// once for each lane. The same source serves double and Pack, so a number gives the same result either way (but for
// multiplications and additions that one of them fuses).
//
// Errors, measured by tests/sdk/pack_math_test.cpp against long double: exp and log below 2 units in the last place
// (log's near 1 too), relaxation(z) below 5.
#pragma once

#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#include "shoal/pack.hpp"

namespace shoal {
inline namespace SHOAL_ISA_NAMESPACE {
namespace pack_math {

inline Pack power_of_two(Pack shifted) { return Pack::from_raw(simd::power_of_two(shifted.v)); }
inline Pack split_exponent(Pack x, Pack& mantissa) {
  return Pack::from_raw(simd::split_exponent(x.v, mantissa.v));
}

inline std::uint64_t bits_of(double x) {
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}
inline double from_bits(std::uint64_t bits) {
  double x;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}
inline double power_of_two(double shifted) { return from_bits((bits_of(shifted) << 52) + bits_of(1.0)); }
inline double split_exponent(double x, double& mantissa) {
  const std::uint64_t bits = bits_of(x), one = bits_of(1.0);
  const std::uint64_t biased = (bits - bits_of(0.70710678118654752) + one) >> 52;
  mantissa = from_bits(bits - (biased << 52) + one);
  return static_cast<double>(biased) - 1023.0;
}

// ln 2 as a sum of two numbers, the first of which has so few digits that its products with exponents are exact.
inline constexpr double ln2_high = 0x1.62e42fee00000p-1, ln2_low = 0x1.a39ef35793c76p-33;

// e^x = 2^n (1 + r q) with |r| <= ln(2) / 2, q = (e^r - 1) / r: 1 + r / 2 + r^2 g, g a polynomial that interpolates at
// the roots of Chebyshev's; the error of 1 + r q is below 3e-17.
template <Real R>
struct Exponential {
  R n, r, q;
  R shifted;  // n + 1.5 * 2^52

  // Of x <= 710.
  [[gnu::always_inline]] explicit Exponential(R x) {
    const R shift(0x1.8p52);
    shifted = x * R(1.4426950408889634) + shift;
    n = shifted - shift;
    r = (x - n * R(ln2_high)) - n * R(ln2_low);
    const R r2 = r * r, r4 = r2 * r2, r8 = r4 * r4;
    const auto pair = [&](double a, double b) { return R(a) + r * R(b); };
    const R low = (pair(1.0, 0.5) + r2 * pair(0x1.5555555555555p-3, 0x1.5555555554cb7p-5)) +
                  r4 * (pair(0x1.1111111110e6ap-7, 0x1.6c16c1738ff55p-10) +
                        r2 * pair(0x1.a01a01a4b322fp-13, 0x1.a019c9a5652d3p-16));
    const R high = pair(0x1.71de17e40edfep-19, 0x1.2880411bad1aap-22) + r2 * R(0x1.af236aac51d05p-26);
    q = low + r8 * high;
  }
  typename RealTraits<R>::MaskType is_small() const { return n == R(0.0); }
  // e^r
  [[gnu::always_inline]] R near_one() const { return R(1.0) + r * q; }
  // 2^n times that: infinity above x = 709.78, not to be used below -707.
  [[gnu::always_inline]] R scaled(R x) const {
    if constexpr (simd::fast_scale && !std::is_same_v<R, double>)
      return R::from_raw(simd::scale(x.v, n.v));
    else  // in two parts, as 2^1024 would overflow
      return x * power_of_two(shifted - R(1.0)) * R(2.0);
  }
  [[gnu::always_inline]] R value() const { return scaled(near_one()); }
};

inline constexpr double smallest_argument = -707.0, largest_argument = 709.78271289338397;

// NaN stays: the second argument of min and max is taken where the two are unordered.
template <Real R>
[[gnu::always_inline]] inline R exponential_of(R x) {
  if constexpr (simd::fast_scale && !std::is_same_v<R, double>) {
    return select(x < R(smallest_argument), R(0.0), Exponential<R>(min(R(710.0), x)).value());
  } else {
    const R e = Exponential<R>(min(R(largest_argument), max(R(smallest_argument), x))).value();
    const R flushed = select(x < R(smallest_argument), R(0.0), e);
    return select(x > R(largest_argument), R(std::numeric_limits<double>::infinity()), flushed);
  }
}

}  // namespace pack_math

/// e^x; 0 below x = -707 (no denormal numbers), infinity above 709.78.
template <Real R>
[[gnu::always_inline]] inline R fast_exp(R x) {
  return pack_math::exponential_of(x);
}

/// Natural logarithm; -infinity at 0 (and of denormal numbers), NaN below.
template <Real R>
[[gnu::always_inline]] inline R fast_log(R x) {
  R m;
  const R n = pack_math::split_exponent(x, m);
  // log m = 2 artanh s, s = (m - 1) / (m + 1), |s| <= 0.1716: the series up to s^21, remainder below 1e-18. The part
  // f - s f that follows from s alone is exact near m = 1.
  const R f = m - R(1.0), s = f * reciprocal(R(2.0) + f), s2 = s * s, s4 = s2 * s2;
  const auto pair = [&](int k) { return R(2.0 / k) + s2 * R(2.0 / (k + 2)); };
  const R series = s2 * (pair(3) + s4 * (pair(7) + s4 * (pair(11) + s4 * (pair(15) + s4 * pair(19)))));
  const R half_square = R(0.5) * f * f;
  const R y = n * R(pack_math::ln2_high) +
              (f - (half_square - (s * (half_square + series) + n * R(pack_math::ln2_low))));
  const double infinity = std::numeric_limits<double>::infinity();
  const R at_ends = select(x < R(std::numeric_limits<double>::min()), R(-infinity),
                           select(x > R(std::numeric_limits<double>::max()), x, y));
  return select(x >= R(0.0), at_ends, R(std::numeric_limits<double>::quiet_NaN()));
}

/// The two numbers of an exact step of dy/dt = q - p y with constant q and p, z = p dt:
///   y(dt) = y decay + q dt mean,  decay = e^-z,  mean = (1 - e^-z) / z, which is 1 at z = 0.
/// For |z| <= 0.34 the mean comes from the exponential's own series, so it loses no digits as z goes to zero.
template <Real R>
struct Relaxation {
  R decay, mean;
};
template <Real R>
[[gnu::always_inline]] inline Relaxation<R> relaxation(R z) {
  const pack_math::Exponential<R> e(
      min(R(pack_math::largest_argument), max(R(pack_math::smallest_argument), R(0.0) - z)));
  const auto is_small = e.is_small();
  const R near_one = e.near_one();
  if (all(is_small)) return {near_one, e.q};  // as below
  const R decay = select(z > R(-pack_math::smallest_argument), R(0.0), e.scaled(near_one));
  // z is never zero where the quotient is taken.
  const R divisor = select(is_small, R(1.0), z);
  return {decay, select(is_small, e.q, (R(1.0) - decay) * reciprocal(divisor))};
}

}  // namespace SHOAL_ISA_NAMESPACE
}  // namespace shoal
