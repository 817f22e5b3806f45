// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Aliev and Panfilov 1996, heart muscle as a whole, without units:
//   du/dt = k u (u - a)(1 - u) - u w
//   dw/dt = eps(u, w) [k u (1 + b - u) - w],   eps = eps0 + mu1 w / (mu2 + u)
// Time counts in units of `time_scale` (12.9 ms fits the action potential of a ventricle).
#pragma once

#include "bistable.hpp"

namespace shoal::diffusion {

struct AlievPanfilov final : ReactionModel<AlievPanfilov, 2> {
  Param<double> k{"k", "1", "Rate of excitation.", positive, default_to(8.0)};
  Param<double> a{"a", "1", "Threshold of excitation.", between(0.0, 1.0), default_to(0.15)};
  Param<double> b{"b", "1", "Shift of the recovery; the original model has b = a.", default_to(0.15)};
  Param<double> epsilon{"epsilon", "1", "eps0, rate of recovery at rest.", positive, default_to(0.002)};
  Param<double> mu1{"mu1", "1", "How the rate of recovery grows with w.", non_negative, default_to(0.2)};
  Param<double> mu2{"mu2", "1", "Excitation at which that growth is halved.", positive, default_to(0.3)};
  Param<double> time_scale{"time_scale", "s", "Unit of the model's time.", positive, default_to(1.0)};

  std::vector<ReactionVariable> variables() const {
    return {
        {"potential", "1", "Transmembrane potential u, 0 at rest and about 1 when excited.", 0.0, 1e-3, 1.0},
        {"recovery", "1", "Recovery variable w.", 0.0, 0.0}};
  }
  double largest_step() const { return 0.5 / k * time_scale; }

  template <Real R>
  Rates<R, 2> rates(const std::array<R, 2>& y) const {
    const R per_second(1.0 / time_scale);
    const R u = y[0], w = y[1];
    const CubicRate<R> cubic = bistable(u, k, a);
    const R rate = (R(epsilon) + R(mu1) * w / (R(mu2) + u)) * per_second;
    return {{cubic.q * per_second, rate * R(k) * u * (R(1.0 + b) - u)}, {(cubic.p + w) * per_second, rate}};
  }
};

}  // namespace shoal::diffusion
