// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Allen and Cahn 1979, separation of two phases:  du/dt = D lap u + (u - u^3) / tau
// It makes the energy  sum of D |grad u|^2 / 2 + (1 - u^2)^2 / (4 tau)  smaller at every time. Divided as
//   q = u (1 + |u|) / tau,  p = |u| (1 + |u|) / tau:  u moves towards sign(u) and never past it.
#pragma once

#include "shoal/reaction_model.hpp"

namespace shoal::diffusion {

struct AllenCahn final : ReactionModel<AllenCahn, 1> {
  Param<double> time_scale{"time_scale", "s", "tau: time in which the reaction works.", positive,
                           default_to(1.0)};

  std::vector<ReactionVariable> variables() const {
    return {{"phase", "1", "Phase of Allen and Cahn, -1 in one phase and 1 in the other.", 0.0, 1e-3}};
  }
  double largest_step() const { return 0.1 * time_scale; }

  template <Real R>
  Rates<R, 1> rates(const std::array<R, 1>& y) const {
    const R u = y[0], magnitude = abs(u), factor = (R(1.0) + magnitude) * R(1.0 / time_scale);
    return {{u * factor}, {magnitude * factor}};
  }
};

}  // namespace shoal::diffusion
