// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Position-based Verlet of one step of a structure (Zhang, Rezavand, Hu 2021), symplectic and of second order:
//   x^(n+1/2) = x^n + dt/2 v^n                          Drift
//   v^(n+1)   = v^n + dt a(x^(n+1/2))                   Kick
//   x^(n+1)   = x^(n+1/2) + dt/2 v^(n+1)                Kick
// Stable for dt < 2 / w, w the largest angular frequency of the discrete body. That depends on the arrangement of the
// particles more than on anything that a speed of sound and a smoothing length could tell, so it is found once by power
// iteration on the undeformed body, and scaled by the speed of waves where the law says that it stiffens.
#pragma once

#include <cstdio>

#include "shoal/particle_operator.hpp"
#include "structure.hpp"

namespace shoal::solid {

struct Drift : ParticleOperator<Drift> {
  In<Vector> velocity{"velocity"};
  InOut<Vector> position{"position"};

  void block(std::uint64_t begin, std::uint64_t end) const {
    const auto d = static_cast<std::uint64_t>(dimensions());
    const double half = 0.5 * dt();
    const double* v = velocity.data();
    double* x = position.data();
    for (std::uint64_t k = begin * d; k < end * d; ++k) x[k] += half * v[k];
  }
};

struct Kick : ParticleOperator<Kick> {
  In<Vector> acceleration{"acceleration"};
  In<Vector> internal{"internal_acceleration", unit("m/s2"), doc("Acceleration by the body's own stress.")};
  InOut<Vector> velocity{"velocity"};
  InOut<Vector> position{"position"};

  void block(std::uint64_t begin, std::uint64_t end) const {
    const auto d = static_cast<std::uint64_t>(dimensions());
    const double step = dt(), half = 0.5 * dt();
    const double *outer = acceleration.data(), *inner = internal.data();
    double *v = velocity.data(), *x = position.data();
    for (std::uint64_t k = begin * d; k < end * d; ++k) {
      v[k] += step * (outer[k] + inner[k]);
      x[k] += half * v[k];
    }
  }
};

// The largest step; looks at no particle but once.
struct StableStep : WeightBuilder {
  double factor = 0.8;  // of the limit of the undeformed body

  void begin() {}
  template <int D>
  void run_chunk(const shoal_chunk&) const {}

  double time_step(double) const {
    if (limit_ == 0.0) {
      build_weights();
      limit_ = 2.0 / structure->weights.largest_frequency(neighbours(0), structure->stiffness());
      const ForceConsistency& made = structure->weights.consistency();
      char text[160];
      std::snprintf(text, sizeof text,
                    "solid: force of a uniform stress inside %.2g, made %.2g in %d iterations; largest "
                    "frequency %.4g rad/s",
                    made.before, made.after, made.iterations, 2.0 / limit_);
      log_debug(text);
    }
    return factor * limit_;
  }

 private:
  mutable double limit_ = 0;  // s; found when the first step is asked for
};

}  // namespace shoal::solid
