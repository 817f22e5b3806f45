// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The step of the loop `diffusion`, and its division into stages.
//   rk2    dt = cfl 2 / lambda
//   rkl2   the step whose error is wanted: with the error e of the last step, over the range of c,
//            dt = 0.8 dt_last (a max(dt_last / T, 0.01) / e)^(1/3),   T the time of the whole run, a the accuracy,
//          at most twice the last step, and at least that of rk2, whose error is of the order of that of the particles'
//          spacing. Where more than a hundred steps are made their errors add up to a; s follows from dt.
//   auto   in each step the one whose step costs less for the time that it covers (cost.hpp); at the end of the run it
//          says which, and why.
// The monotone scheme with rk2 or auto: rk2 with dt <= 1 / k too (limiter.hpp), so that it is monotone in time as well.
#pragma once

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "cost.hpp"
#include "integrator.hpp"
#include "stencil.hpp"

namespace shoal::diffusion {

enum class Integrator { rk2, rkl2, automatic };

// What `auto` chose, for the user.
struct StepsDone {
  double steps = 0, super = 0;   // all, and those of rkl2
  double ns = 0, ns_of_rk2 = 0;  // what they cost, and what they would have with rk2 alone
  double longest = 0;            // over the longest step that rk2 is stable with

  void add(const StepCost& cost, bool pays, int stages, double lambda_dt) {
    steps += 1.0;
    super += pays ? 1.0 : 0.0;
    ns += stages > 2 ? cost.rkl2(stages) : cost.rk2();
    ns_of_rk2 += cost.rk2() * std::max(1.0, 0.5 * lambda_dt);
    longest = std::max(longest, 0.5 * lambda_dt);
  }
  std::string text(double accuracy) const {
    char line[300];
    if (super == 0.0)
      std::snprintf(line, sizeof line,
                    "rk2 in all %.0f steps: the accuracy %.2g, or who else limits the step, allowed none "
                    "longer than %.3g "
                    "times the longest that rk2 is stable with, too short for rkl2 to cost less",
                    steps, accuracy, longest);
    else
      std::snprintf(line, sizeof line,
                    "rkl2 in %.0f of %.0f steps, rk2 in the others, at %.2g of the cost of rk2 alone: the "
                    "accuracy %.2g "
                    "allowed steps of up to %.3g times the longest that rk2 is stable with",
                    super, steps, ns / ns_of_rk2, accuracy, longest);
    return line;
  }
};

struct OuterStep : ParticleOperator<OuterStep> {
  std::vector<std::shared_ptr<const Stencil>> stencils;  // of all bodies
  std::shared_ptr<Stages> stages;
  Integrator integrator = Integrator::rk2;
  double cfl = 1;
  double accuracy = 1e-4;
  double duration = 1;     // s, of the run
  int most_stages = 1001;  // rounding errors grow with s^2
  std::string what;        // field and body
  double particles = 0;    // of all bodies
  int expressions = 0;     // kinds of them that an evaluation of the rate looks up
  std::shared_ptr<const OtherWork> others = std::make_shared<OtherWork>();

  double time_step(double) const {
    const double explicit_step = cfl * 2.0 / spectral_radius();
    if (monotone()) return std::min(explicit_step, 1.0 / limiter_rate());
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
    const bool plain = integrator == Integrator::automatic && !pays(std::min(wanted, others->longest_step));
    return plain ? std::min(wanted, explicit_step) : wanted;
  }

  void begin() {
    const double lambda_dt = dt() * spectral_radius() / cfl;
    const int s = Legendre::stages(lambda_dt);
    // In auto rk2 knows nothing of its error: every tenth step measures it with rkl2 of three stages.
    const bool pays_now = lambda_dt > 2.0 * (1.0 + 1e-9);
    const bool measures = integrator == Integrator::automatic && (pays_now || step().number % 10 == 1);
    const bool super = integrator == Integrator::rkl2 || (measures && !monotone());
    stages->super = super;
    stages->number = super ? s : 2;
    stages->step = dt();
    stages->start = time();
    if (super) stages->forget_error();
    done_.add(cost(), pays_now, super ? s : 2, lambda_dt);
  }
  std::string remark() const {
    if (integrator != Integrator::automatic || done_.steps == 0.0) return "";
    if (monotone()) return what + ": rk2 in steps that make no new extrema; rkl2 has no proof of that";
    return what + ": " + done_.text(accuracy);
  }
  void save(const shoal_stream& stream) const {
    const double state[6] = {stages->step,      stages->measured_step, stages->squares,
                             stages->particles, stages->lowest,        stages->highest};
    check_host(stream.write(stream.context, state, sizeof state));
    check_host(stream.write(stream.context, &done_, sizeof done_));
  }
  void load(const shoal_stream& stream) {
    double state[6];
    check_host(stream.read(stream.context, state, sizeof state));
    check_host(stream.read(stream.context, &done_, sizeof done_));
    stages->step = state[0];
    stages->measured_step = state[1];
    stages->squares = state[2];
    stages->particles = state[3];
    stages->lowest = state[4];
    stages->highest = state[5];
  }

 private:
  // Whether steps must be monotone: a choice of rkl2 is the user's.
  bool monotone() const { return integrator != Integrator::rkl2 && limiter_rate() > 0.0; }
  double limiter_rate() const {
    double largest = 0;
    for (const auto& stencil : stencils) largest = std::max(largest, stencil->limiter_rate);
    return largest;
  }
  double spectral_radius() const {
    double largest = 0;
    for (const auto& stencil : stencils) largest = std::max(largest, stencil->spectral_radius);
    return largest;
  }
  StepCost cost() const {
    double neighbours = 0;
    for (const auto& stencil : stencils)
      for (const auto& weights : stencil->weights)  // the limiter looks at each three times
        neighbours += (stencil->limited ? 3.0 : 1.0) * static_cast<double>(weights.size());
    return {particles, neighbours, expressions, others->ns};
  }
  // Whether a step of rkl2 costs less than the steps of rk2 that cover it.
  bool pays(double step) const {
    const double lambda_dt = step * spectral_radius() / cfl;
    const StepCost one = cost();
    return one.rkl2(Legendre::stages(lambda_dt)) < one.rk2() * std::max(1.0, 0.5 * lambda_dt);
  }

  StepsDone done_;
};

}  // namespace shoal::diffusion
