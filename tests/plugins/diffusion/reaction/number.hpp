// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A plain number with the functions of the C library, in whose place code over a real type otherwise has the SDK's own:
// what a model written for one cell after the other would call.
#pragma once

#include <cmath>

#include "shoal/pack.hpp"
#include "shoal/pack_math.hpp"

namespace shoal::diffusion::test {
struct Number;
}

template <>
struct shoal::RealTraits<shoal::diffusion::test::Number> {
  using MaskType = bool;
  static constexpr int lanes = 1;
};

namespace shoal::diffusion::test {

struct Number {
  double x = 0;

  Number() = default;
  explicit Number(double value) : x(value) {}
  explicit operator double() const { return x; }

  friend Number operator+(Number a, Number b) { return Number(a.x + b.x); }
  friend Number operator-(Number a, Number b) { return Number(a.x - b.x); }
  friend Number operator*(Number a, Number b) { return Number(a.x * b.x); }
  friend bool operator>=(Number a, Number b) { return a.x >= b.x; }
  friend Number select(bool m, Number a, Number b) { return m ? a : b; }
  friend Number sqrt(Number a) { return Number(std::sqrt(a.x)); }
  friend Number reciprocal(Number a) { return Number(1.0 / a.x); }
  friend Number fast_exp(Number a) { return Number(std::exp(a.x)); }
  friend Number fast_log(Number a) { return Number(std::log(a.x)); }
  friend Relaxation<Number> relaxation(Number z) {
    const double decay = std::exp(-z.x);
    const double mean = std::fabs(z.x) < 1e-5 ? 1.0 - 0.5 * z.x + z.x * z.x / 6 : (1.0 - decay) / z.x;
    return {Number(decay), Number(mean)};
  }
};

}  // namespace shoal::diffusion::test
