// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The step of the loop `diffusion`, and its division into stages.
//   rk2    dt = cfl 2 / lambda
//   rkl2   the step whose error is wanted: with the error e of the last step, over the range of c,
//            dt = 0.8 dt_last (a max(dt_last / T, 0.01) / e)^(1/3),   T the time of the whole run, a the accuracy,
//          at most twice the last step, and at least that of rk2, whose error is of the order of that of the particles'
//          spacing. Where more than a hundred steps are made their errors add up to a; s follows from dt.
//   auto   rkl2 where its stages for that step cost less than rk2's, two for each step at its limit; else rk2. Both
//          are counted in evaluations of the rate, so that the choice does not depend on the machine.
#pragma once

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "integrator.hpp"
#include "stencil.hpp"

namespace shoal::diffusion {

enum class Integrator { rk2, rkl2, automatic };

struct OuterStep : ParticleOperator<OuterStep> {
  std::vector<std::shared_ptr<const Stencil>> stencils;  // of all bodies
  std::shared_ptr<Stages> stages;
  Integrator integrator = Integrator::rk2;
  double cfl = 1;
  double accuracy = 1e-4;
  double duration = 1;     // s, of the run
  int most_stages = 1001;  // rounding errors grow with s^2
  std::string what;        // field and body, for the log

  double time_step(double) const {
    const double explicit_step = cfl * 2.0 / spectral_radius();
    if (integrator == Integrator::rk2) return explicit_step;
    // The first step is one of rk2: nothing is known of the error yet.
    double wanted = explicit_step;
    const double error = stages->error(), measured = stages->measured_step;
    if (error >= 0.0 && measured > 0.0) {
      const double allowed = accuracy * std::max(measured / duration, 0.01);
      wanted = 0.8 * measured * std::cbrt(allowed / std::max(error, 1e-300));
      wanted = std::max(explicit_step, std::min(wanted, 2.0 * stages->step));
    }
    wanted = std::min(wanted, cfl * Legendre::reach(most_stages) / spectral_radius());
    return integrator == Integrator::automatic && !pays(wanted) ? std::min(wanted, explicit_step) : wanted;
  }

  void begin() {
    const double lambda_dt = dt() * spectral_radius() / cfl;
    const int s = Legendre::stages(lambda_dt);
    // rk2 knows nothing of its error: every tenth step measures it with rkl2 of three stages.
    const bool pays_now = lambda_dt > 2.0 * (1.0 + 1e-9);
    const bool super = integrator == Integrator::rkl2 || pays_now || step().number % 10 == 1;
    if (integrator == Integrator::automatic && pays_now != was_paying_ && reports_ < 3) {
      report(pays_now, s, lambda_dt);
      ++reports_;
    }
    was_paying_ = pays_now;
    stages->super = super;
    stages->number = super ? s : 2;
    stages->step = dt();
    stages->start = time();
    if (super) stages->forget_error();
  }
  void save(const shoal_stream& stream) const {
    const double state[6] = {stages->step,      stages->measured_step, stages->squares,
                             stages->particles, stages->lowest,        stages->highest};
    check_host(stream.write(stream.context, state, sizeof state));
  }
  void load(const shoal_stream& stream) {
    double state[6];
    check_host(stream.read(stream.context, state, sizeof state));
    stages->step = state[0];
    stages->measured_step = state[1];
    stages->squares = state[2];
    stages->particles = state[3];
    stages->lowest = state[4];
    stages->highest = state[5];
  }

 private:
  double spectral_radius() const {
    double largest = 0;
    for (const auto& stencil : stencils) largest = std::max(largest, stencil->spectral_radius);
    return largest;
  }
  // Whether rkl2 covers this step with fewer evaluations than rk2, which needs lambda dt of them. A stage of rkl2 costs
  // a tenth more than one of rk2 (measured in 2D with 20 neighbours).
  bool pays(double step) const {
    const double lambda_dt = step * spectral_radius() / cfl;
    return 1.1 * Legendre::stages(lambda_dt) < lambda_dt;
  }
  void report(bool super, int s, double lambda_dt) const {
    char text[240];
    const double ratio = s / lambda_dt;
    if (super)
      std::snprintf(
          text, sizeof text,
          "%s at %.4g s: rkl2, as a step of %.4g s has the accuracy %.2g and takes %d evaluations of the "
          "rate, %.2f of those of rk2",
          what.c_str(), time(), dt(), accuracy, s, ratio);
    else
      std::snprintf(
          text, sizeof text,
          "%s at %.4g s: rk2, as the accuracy %.2g allows a step of %.4g s only, which is stable with "
          "its 2 evaluations of the rate",
          what.c_str(), time(), accuracy, dt());
    host().log(SHOAL_LOG_INFO, text);
  }

  bool was_paying_ = false;
  int reports_ = 0;
};

}  // namespace shoal::diffusion
