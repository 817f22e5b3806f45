// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The cubic rate of the models with two stable states, k u (u - a)(1 - u), as q - p u with p >= 0 and q / p the state
// that u moves to: 0 below the threshold a, 1 above it,
//   u < a:   q = 0,             p = k (a - u)(1 - u)
//   u >= a:  q = p = k u (u - a)
// so that u never overshoots its state, however long the step (0 <= a < 1; the division k u^2 (1 + a), k (u^2 + a),
// which is found in print, strives for (1 + a) u^2 / (u^2 + a) and does).
#pragma once

#include "shoal/reaction_model.hpp"

namespace shoal::diffusion {

template <Real R>
struct CubicRate {
  R q, p;
};

template <Real R>
CubicRate<R> bistable(R u, double k, double a) {
  const auto below = u < R(a);
  // Above 1 the state is 1, and u (u - a) is positive; below 0 it is 0, and both factors are positive.
  const R up = R(k) * u * (u - R(a));
  return {select(below, R(0.0), up), select(below, R(k) * (R(a) - u) * (R(1.0) - u), up)};
}

}  // namespace shoal::diffusion
