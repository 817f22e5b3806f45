// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Stages of rk2 and rkl2 on dc/dt = -lambda c.
#include <doctest/doctest.h>

#include "integrator.hpp"
#include "particles.hpp"
#include "step.hpp"

using namespace shoal;
using namespace shoal::diffusion;
using namespace shoal::diffusion::test;

namespace {

// One step of each particle with a lambda of its own; returns c at its end from 1.
template <class Stage>
std::vector<double> one_step(const std::vector<double>& lambda, double dt, bool super, int number,
                             Stages* out = nullptr) {
  std::vector<double> positions(2 * lambda.size());
  Body body(2, positions);
  body.set("c", 1.0);
  const auto stages = std::make_shared<Stages>();
  stages->super = super;
  stages->number = number;
  stages->step = dt;
  Stage op;
  op.set("c");
  op.stages = stages;
  for (int j = 0; j < number; ++j) {
    body.set_each("c_rate", 1, [&](std::size_t i, std::size_t) { return -lambda[i] * body["c"][i]; });
    testing::run(op, body, {}, {.dt = dt / number, .time = j * dt / number});
  }
  if (out != nullptr) *out = *stages;
  return {body["c"].begin(), body["c"].begin() + static_cast<std::ptrdiff_t>(lambda.size())};
}

// Legendre's polynomial by its recurrence
double legendre(int s, double x) {
  double before = 1.0, now = x;
  for (int k = 2; k <= s; ++k) {
    const double next = ((2.0 * k - 1.0) * x * now - (k - 1.0) * before) / k;
    before = now;
    now = next;
  }
  return now;
}

}  // namespace

TEST_CASE("rk2 is 1 - z + z^2 / 2, in both of its forms") {
  const std::vector<double> lambda{0.0, 0.5, 1.0, 2.0};
  for (const double dt : {0.3, 1.0}) {
    const auto plain = one_step<HeunStage>(lambda, dt, false, 2);
    const auto super = one_step<SuperStage>(lambda, dt, false, 2);
    for (std::size_t i = 0; i < lambda.size(); ++i) {
      const double z = lambda[i] * dt;
      CHECK(plain[i] == doctest::Approx(1 - z + 0.5 * z * z).epsilon(1e-14));
      CHECK(super[i] == doctest::Approx(1 - z + 0.5 * z * z).epsilon(1e-14));
    }
  }
}

TEST_CASE("rkl2 is the stability polynomial of its paper, and stable up to its reach") {
  for (const int s : {3, 5, 21}) {
    const double w1 = 4.0 / (s * s + s - 2.0), b = (s * s + s - 2.0) / (2.0 * s * (s + 1.0));
    std::vector<double> lambda;
    for (int k = 0; k <= 50; ++k) lambda.push_back(Legendre::reach(s) * k / 50);
    const auto c = one_step<SuperStage>(lambda, 1.0, true, s);
    for (std::size_t i = 0; i < lambda.size(); ++i) {
      CHECK(c[i] == doctest::Approx(1.0 - b + b * legendre(s, 1.0 - w1 * lambda[i])).epsilon(1e-10));
      CHECK(std::abs(c[i]) <= 1.0 + 1e-12);
    }
  }
}

TEST_CASE("rkl2 is of second order, and its estimate of the error of third, as is the error of a step") {
  double last_error = 0, last_estimate = 0;
  for (const double dt : {0.2, 0.1, 0.05}) {
    Stages stages;
    const auto c = one_step<SuperStage>({1.0, 0.5}, dt, true, 5, &stages);
    const double error = std::abs(c[0] - std::exp(-dt)), estimate = stages.error();
    if (last_error > 0.0) {
      CHECK(last_error / error == doctest::Approx(8.0).epsilon(0.1));
      CHECK(last_estimate / estimate ==
            doctest::Approx(4.0).epsilon(0.2));  // over a range that shrinks with dt
    }
    last_error = error;
    last_estimate = estimate;
  }
}

TEST_CASE("stages are the smallest odd number that is stable") {
  for (const double z : {0.1, 1.0, 5.0, 40.0, 4000.0}) {
    const int s = Legendre::stages(z);
    CHECK(s % 2 == 1);
    CHECK(Legendre::reach(s) >= z * (1 - 1e-9));
    if (s > 3) CHECK(Legendre::reach(s - 2) < z);
  }
}

TEST_CASE("auto takes rk2 where the accuracy allows short steps only, rkl2 where it allows long ones") {
  const auto stencil = std::make_shared<Stencil>();
  stencil->spectral_radius = 100.0;
  OuterStep op;
  stencil->weights.emplace_back(20 * 1000);
  op.stencils = {stencil};
  op.particles = 1000;
  const auto others = std::make_shared<OtherWork>();
  op.others = others;
  op.stages = std::make_shared<Stages>();
  op.integrator = Integrator::automatic;
  op.accuracy = 1e-4;
  op.duration = 1.0;
  CHECK(op.time_step(0) == doctest::Approx(0.02));  // nothing is known yet
  Stages& stages = *op.stages;
  stages.step = stages.measured_step = 0.02;
  stages.particles = 1, stages.lowest = 0, stages.highest = 1;
  stages.squares = 1e-4 * 1e-4;  // far above 0.02 of the accuracy
  CHECK(op.time_step(0) == doctest::Approx(0.02));
  stages.step = stages.measured_step = 0.2;
  stages.squares = std::pow(0.2 * 1e-4 / 8, 2);  // an eighth of what is allowed: 1.6 times as long
  CHECK(op.time_step(0) == doctest::Approx(0.32));
  CHECK(Legendre::stages(0.32 * 100) == 9);
  // A reaction that allows 0.03 s: three stages are no cheaper than one step and a half of rk2, unless each of those pays
  // for a step of the reaction too.
  others->longest_step = 0.03;
  CHECK(op.time_step(0) == doctest::Approx(0.02));
  others->ns = 1000 * 2 * 19 * measured::reaction_variable;
  CHECK(op.time_step(0) == doctest::Approx(0.32));
}

TEST_CASE("a wrong ratio of the measured costs makes a step of auto little dearer") {
  for (const auto& [ratio, bound] : {std::pair{2.0, 0.08}, std::pair{4.0, 0.16}}) {
    const double wrong = ratio;  // which a lambda may capture; a binding only in later C++
    double worst = 0;
    for (double length = 1.0; length < 31.0; length += 0.05)  // over the longest step of rk2
      for (double other = 0.1; other < 1e4; other *= 1.25)
        for (const double factor : {wrong, 1.0 / wrong}) {
          const int stages = Legendre::stages(2.0 * length);
          const StepCost believed(1.0, 30.0, 0, other);
          StepCost real = believed;
          real.rate *= factor;
          const double super = real.rkl2(stages), plain = real.rk2() * length;
          const bool takes_super = believed.rkl2(stages) < believed.rk2() * length;
          worst = std::max(worst, (takes_super ? super : plain) / std::min(super, plain) - 1.0);
        }
    INFO(wrong);
    CHECK(worst > 0.01);
    CHECK(worst < bound);
  }
}

TEST_CASE("rk2 has two stages in all steps; the monotone scheme takes steps that make no new extrema") {
  const auto stencil = std::make_shared<Stencil>();
  stencil->spectral_radius = 100.0;
  OuterStep op;
  op.stencils = {stencil};
  op.stages = std::make_shared<Stages>();
  op.integrator = Integrator::rk2;
  const auto stages_of = [&](std::uint64_t number) {
    shoal_step step{};
    step.size = sizeof step;
    step.dimensions = 2;
    step.number = number;
    step.dt = step.parent_dt = 0.01;
    op.set_step(step);
    op.begin();
    return op.stages->number;
  };
  for (const std::uint64_t number : {1U, 2U, 11U}) CHECK(stages_of(number) == 2);
  op.integrator = Integrator::automatic;
  CHECK(stages_of(1) == 3);
  CHECK(stages_of(2) == 2);
  stencil->limiter_rate = 125.0;
  CHECK(op.time_step(0) == doctest::Approx(0.008));
  CHECK(stages_of(1) == 2);
  op.integrator = Integrator::rkl2;
  CHECK(op.time_step(0) == doctest::Approx(0.02));
}
