// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Steps of dy/dt = q(y) - p(y) y, block by block of particles. With q and p constant the step is exact,
//   y(dt) = y e^(-p dt) + q dt (1 - e^(-p dt)) / (p dt)                (Rush and Larsen 1978, Wang et al. 2019)
// and so unconditionally stable. With q and p of the middle of the step, it is of second order (exponential midpoint
// rule, second-order Rush-Larsen: Perego and Veneziani 2009). The middle is found implicitly with q and p of the
// beginning, y + h (q - p y) / (1 + h p), h = dt / 2, which lies between y and q / p as well and needs no exponential.
//
// Where the reaction is fast for a moment (the upstroke of an action potential), the step of these particles alone is
// cut: the difference to the end that the beginning predicts, y + 2 h (q - p y) / (1 + h p), must stay below the
// variable's tolerance, else the particle starts again with 2, 4, ... steps. Each particle decides for itself, so
// results do not depend on who shares its block.
#pragma once

#include <cstdint>
#include <vector>

#include "shoal/host.hpp"
#include "shoal/interfaces/reaction_model.h"
#include "shoal/physics.hpp"

namespace shoal::diffusion {

class ReactionIntegrator {
 public:
  // `adaptive`: steps may be cut; else every particle takes the whole one.
  explicit ReactionIntegrator(Interface<shoal_reaction_model> model, bool adaptive = true);

  std::size_t n_variables() const { return n_; }
  const shoal_reaction_variable& variable(std::size_t v) const {
    return *SHOAL_AT(shoal_reaction_variable, variables_, v);
  }

  // Particles 0 ... n-1: their positions (interleaved), fields y[v][i], and what is added to q of the first variable,
  // constant over the step (a stimulus, in units of the variable per second; null: nothing).
  // Field arrays may be read up to the next multiple of SHOAL_PADDING.
  void advance(int dimensions, double t, double dt, std::uint64_t n, const double* position, double* const* y,
               const double* source) const;

  static constexpr int max_halvings = 8;

 private:
  struct Work;
  void step(Work& w, int dimensions, double t, double dt, std::uint64_t n, const double* position,
            const double* const* y, const double* source) const;
  void advance_block(int dimensions, double t, double dt, std::uint64_t n, const double* position,
                     double* const* y, const double* source) const;
  void refine(Work& w, int dimensions, double t, double dt, const double* position, double* const* y,
              const double* source) const;

  Interface<shoal_reaction_model> model_;
  const shoal_reaction_variable* variables_ = nullptr;
  std::size_t n_ = 0;
  std::uint64_t block_ = 0;
  bool adaptive_;
};

}  // namespace shoal::diffusion
