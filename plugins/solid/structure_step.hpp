// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Position-based Verlet of one step of a structure (Zhang, Rezavand, Hu 2021), symplectic and of second order:
//   x^(n+1/2) = x^n + dt/2 v^n                          Drift
//   v^(n+1)   = v^n + dt a(x^(n+1/2))                   Kick
//   x^(n+1)   = x^(n+1/2) + dt/2 v^(n+1)                Kick
// Stable for dt < 2 / w, w the largest angular frequency of the discrete body. That depends on the arrangement of the
// particles more than on anything that a speed of sound and a smoothing length could tell, so it is found once by
// iteration on the undeformed body, and scaled by the speed of waves where the law says that it stiffens. Contact adds
// to w^2 (added_stiffness.hpp). Damping at a rate 2 zeta w of the fastest mode is a step late, which leaves
//   dt < 2 / w (sqrt(1 + zeta^2) - zeta).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "added_stiffness.hpp"
#include "shoal/particle_operator.hpp"
#include "stress.hpp"

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

// How fast waves are on top of the deformation, for laws that stiffen. It costs about ten times the stress, so it is
// looked at the more seldom the less it changes, and taken to rise by as much again until it is looked at next.
struct WaveSpeed : ParticleOperator<WaveSpeed> {
  In<Matrix> F{"deformation_gradient"};
  Maximum speed;
  DeclaredFields law_fields{*this};
  SharedStructure structure;

  template <int D>
  void run_chunk(const shoal_chunk& chunk) const {
    if (step().number < state_.next) return;
    std::array<double*, DeclaredFields::most> fields;
    law_fields.at(chunk.begin, fields.data());
    const shoal_stress_block block =
        stress_block(*structure, chunk.end - chunk.begin, F.data() + chunk.begin * D * D, fields.data());
    std::vector<double> speeds(chunk.end - chunk.begin);
    check_host(structure->law.api->wave_speed(structure->law.self, &block, speeds.data()));
    for (const double one : speeds) speed.update(Particle<D>{0, chunk.partial}, one);
  }
  void end() {
    if (step().number < state_.next) return;
    const double rise = state_.last > 0.0 ? speed.result() / state_.last - 1.0 : 0.0;
    if (std::fabs(rise) < 0.01)
      state_.interval = std::min<std::uint64_t>(2 * state_.interval, 80);
    else if (!(std::fabs(rise) < 0.04))
      state_.interval = std::max<std::uint64_t>(state_.interval / 2, 5);
    state_.next = step().number + state_.interval;
    state_.last = speed.result();
    state_.speed = structure->wave_speed = state_.last * (1.0 + std::clamp(rise, 0.0, 0.25));
  }
  void save(const shoal_stream& stream) const {
    check_host(stream.write(stream.context, &state_, sizeof state_));
  }
  void load(const shoal_stream& stream) {
    check_host(stream.read(stream.context, &state_, sizeof state_));
    structure->wave_speed = state_.speed;
  }

 private:
  struct State {
    std::uint64_t next = 0, interval = 5;  // steps
    double last = 0, speed = 0;            // m/s; what was found, and what is reckoned with
  } state_;
};

// The largest step; looks at no particle but once.
struct StableStep : WeightBuilder {
  double factor = 0.95;  // of the limit of the undeformed body
  double viscosity = 0;  // Pa s, of Kelvin-Voigt damping
  double damping = 0;    // 1/s, rate at which all other damping takes velocity from the fastest mode, at most
  SharedStiffness added;  // of contact

  void begin() {}
  template <int D>
  void run_chunk(const shoal_chunk&) const {}

  double time_step(double) const {
    if (limit_ == 0.0) {
      build_weights();
      const double own = structure->weights.largest_frequency(structure->stiffness(), volume.data());
      const double w = std::sqrt(own * own + *added / structure->constants.density);
      const double c = structure->constants.longitudinal_speed;
      const double ratio =  // of critical damping
          viscosity * w / (structure->constants.density * c * c) + 0.5 * damping / w;
      limit_ = 2.0 / w * (std::sqrt(1.0 + ratio * ratio) - ratio);
      const ForceConsistency& made = structure->weights.consistency();
      char text[160];
      std::snprintf(text, sizeof text,
                    "solid: force of a uniform stress inside %.2g, made %.2g in %d iterations; largest "
                    "frequency %.4g rad/s",
                    made.before, made.after, made.iterations, own);
      log_debug(text);
    }
    const double undeformed = structure->constants.longitudinal_speed;
    // A NaN must not be lost: it stops the run.
    const double now = structure->wave_speed;
    return factor * limit_ * (now <= undeformed ? 1.0 : undeformed / now);
  }

 private:
  mutable double limit_ = 0;  // s; found when the first step is asked for
};

}  // namespace shoal::solid
