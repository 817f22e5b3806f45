// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The step of the loop `diffusion`, and its division into stages.
#pragma once

#include <memory>

#include "integrator.hpp"
#include "stencil.hpp"

namespace shoal::diffusion {

// dt <= 2 / lambda, lambda the spectral radius: the stability limit of Heun's method.
struct OuterStep : ParticleOperator<OuterStep> {
  std::shared_ptr<const Stencil> stencil;
  std::shared_ptr<Stages> stages;
  double cfl = 1;

  double time_step(double) const { return cfl * 2.0 / stencil->spectral_radius; }
  void begin() {
    stages->number = 2;
    stages->step = dt();
    stages->start = time();
  }
};

}  // namespace shoal::diffusion
