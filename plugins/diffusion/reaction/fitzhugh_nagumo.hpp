// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// FitzHugh 1961, Nagumo 1962, an excitable medium without units:
//   du/dt = u (u - a)(1 - u) - w
//   dw/dt = eps (beta u - gamma w - sigma)
// Time counts in units of `time_scale`.
#pragma once

#include "bistable.hpp"

namespace shoal::diffusion {

struct FitzHughNagumo final : ReactionModel<FitzHughNagumo, 2> {
  Param<double> a{"a", "1", "Threshold of excitation.", between(0.0, 1.0), default_to(0.1)};
  Param<double> epsilon{"epsilon", "1", "Rate of the recovery.", positive, default_to(0.01)};
  Param<double> beta{"beta", "1", "How strongly the excitation raises the recovery variable.",
                     default_to(0.5)};
  Param<double> gamma{"gamma", "1", "Decay of the recovery variable.", non_negative, default_to(1.0)};
  Param<double> sigma{"sigma", "1", "Constant that shifts the state of rest.", default_to(0.0)};
  Param<double> time_scale{"time_scale", "s", "Unit of the model's time.", positive, default_to(1.0)};

  std::vector<ReactionVariable> variables() const {
    return {
        {"potential", "1", "Transmembrane potential u, 0 at rest and about 1 when excited.", 0.0, 1e-3, 1.0},
        {"recovery", "1", "Recovery variable w.", 0.0, 0.0}};
  }
  double largest_step() const { return 0.5 * time_scale; }

  template <Real R>
  Rates<R, 2> rates(const std::array<R, 2>& y) const {
    const R per_second(1.0 / time_scale);
    const CubicRate<R> cubic = bistable(y[0], 1.0, a);
    return {{(cubic.q - y[1]) * per_second, R(epsilon) * (R(beta) * y[0] - R(sigma)) * per_second},
            {cubic.p * per_second, R(epsilon * gamma) * per_second}};
  }
};

}  // namespace shoal::diffusion
