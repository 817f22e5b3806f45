// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Time integration of one step of the loop `diffusion` in stages, each of which is a step of a loop inside it: rates
// are summed up by whatever adds to <field>_rate, then c moves on.
#pragma once

#include <cmath>
#include <memory>

#include "shoal/particle_operator.hpp"
#include "species.hpp"

namespace shoal::diffusion {

// What the operators of one field share in a step.
struct Stages {
  int number = 2;    // of stages in this step
  double step = 0;   // s, the whole step
  double start = 0;  // s, time at its beginning

  // Time in stage `inner`, s.
  double time_of(const shoal_step& inner) const { return current(inner) == 1 ? start : start + step; }
  // 1, 2, ...: the stage that a step of the inner loop is.
  int current(const shoal_step& inner) const {
    return 1 + static_cast<int>(std::lround((inner.time - start) / step * number));
  }
};

// Divides the step into stages: the inner loop follows its limit.
struct InnerStep : ParticleOperator<InnerStep> {
  std::shared_ptr<const Stages> stages;
  double time_step(double) const { return stages->step / stages->number; }
};

// Heun's method, second order, strong-stability preserving (Shu, Osher 1988):
//   c1 = c0 + dt L(c0),   c = (c0 + c1 + dt L(c1)) / 2
// Stable for dt <= 2 / lambda, lambda the largest eigenvalue of -L; no new extrema for dt <= 1 / max_i sum_j l_ij where
// no l_ij is negative.
struct HeunStage : ParticleOperator<HeunStage> {
  InOut<Scalar> value{"value"};
  InOut<Scalar> start{"start", doc("Value at the beginning of the step."), derived};
  In<Scalar> rate{"rate"};

  std::shared_ptr<const Stages> stages;
  Names names;

  void set(const std::string& field) {
    value.rename(names.keep(field));
    start.rename(names.keep(start_of(field)));
    rate.rename(names.keep(rate_of(field)));
  }
  void begin() { first_ = stages->current(step()) == 1; }
  void block(std::uint64_t begin, std::uint64_t end) const {
    double* c = value.data();
    double* c0 = start.data();
    const double* l = rate.data();
    const double dt = stages->step;
    if (first_)
      for (std::uint64_t i = begin; i < end; ++i) {
        c0[i] = c[i];
        c[i] += dt * l[i];
      }
    else
      for (std::uint64_t i = begin; i < end; ++i) c[i] = 0.5 * (c0[i] + c[i] + dt * l[i]);
  }

 private:
  bool first_ = true;
};

}  // namespace shoal::diffusion
