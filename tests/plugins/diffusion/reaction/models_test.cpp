// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The integrator with the models of two variables and less: exact where it must be, second order, bounded at any step.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>

#include "aliev_panfilov.hpp"
#include "allen_cahn.hpp"
#include "cells.hpp"
#include "fitzhugh_nagumo.hpp"

using namespace shoal;
using namespace shoal::diffusion;
using namespace shoal::diffusion::test;

namespace {

// dy/dt = q - p y with the same constants everywhere.
struct Constant final : ReactionModel<Constant, 1> {
  double q = 0, p = 0;
  std::vector<ReactionVariable> variables() const { return {{"y", "1", "y", 1.0, 0.0}}; }
  double largest_step() const { return 1.0; }
  template <Real R>
  Rates<R, 1> rates(const std::array<R, 1>&) const {
    return {{R(q)}, {R(p)}};
  }
};

// The rates of the models as the literature prints them.
double allen_cahn(double u) { return u - u * u * u; }
std::array<double, 2> fitzhugh_nagumo(double u, double w) {
  return {u * (u - 0.1) * (1 - u) - w, 0.01 * (0.5 * u - w)};
}
std::array<double, 2> aliev_panfilov(double u, double w) {
  const double k = 8, a = 0.15, b = 0.15, eps = 0.002 + 0.2 * w / (u + 0.3);
  return {-k * u * (u - a) * (u - 1) - u * w, eps * (-w - k * u * (u - b - 1))};
}

// Error of the first variable after `time` in steps of dt, without steps of the particles' own.
template <class Model, std::size_t N>
double error(const Model& model, std::array<double, N> start, double time, int steps, double reference) {
  const ReactionIntegrator integrator(interface_of(model), false);
  Cells cells(integrator, 3);
  for (std::size_t v = 0; v < N; ++v) cells[v].assign(8, start[v]);
  for (int k = 0; k < steps; ++k) cells.advance(k * time / steps, time / steps);
  return std::fabs(cells[0][1] - reference);
}

template <class Model, std::size_t N>
void check_second_order(const Model& model, std::array<double, N> start, double time, int steps) {
  const double reference = runge_kutta(model, start, time, 20000)[0];
  const double coarse = error(model, start, time, steps, reference),
               fine = error(model, start, time, 2 * steps, reference),
               finest = error(model, start, time, 4 * steps, reference);
  CHECK(coarse > 1e-9);  // there is an error to look at
  CHECK(std::log2(coarse / fine) > 1.8);
  CHECK(std::log2(fine / finest) > 1.9);
}

}  // namespace

TEST_CASE("with constant q and p a step of any length is exact, also where p vanishes") {
  for (const double p : {0.0, 1e-300, 1e-12, 1e-3, 0.7, 40.0, 1e6, -0.2})
    for (const double dt : {1e-9, 0.01, 1.0, 30.0}) {
      Constant model;
      model.q = 0.3;
      model.p = p;
      const ReactionIntegrator integrator(interface_of(model));
      Cells cells(integrator, 11);
      cells.advance(0.0, dt);
      const long double z = static_cast<long double>(p) * dt;
      const long double mean = z == 0 ? 1.0L : -std::expm1(-z) / z;
      const auto exact = static_cast<double>(std::exp(-z) + 0.3L * dt * mean);
      for (std::size_t i = 0; i < 11; ++i) CHECK(cells[0][i] == doctest::Approx(exact).epsilon(1e-14));
    }
}

TEST_CASE("the division into q and p keeps the rates of the papers") {
  const WithDefaults<AllenCahn> phases_;
  const WithDefaults<FitzHughNagumo> nagumo_;
  const WithDefaults<AlievPanfilov> muscle_;
  const AllenCahn& phases = phases_;
  const FitzHughNagumo& nagumo = nagumo_;
  const AlievPanfilov& muscle = muscle_;
  for (double u = -1.5; u < 1.6; u += 0.05) {
    const auto r = phases.rates(std::array<double, 1>{u});
    CHECK(r.q[0] - r.p[0] * u == doctest::Approx(allen_cahn(u)).epsilon(1e-12));
    for (const double w : {0.0, 0.1, 1.7}) {
      const std::array<double, 2> y{u, w};
      const auto f = nagumo.rates(y);
      const auto exact = fitzhugh_nagumo(u, w);
      for (std::size_t v = 0; v < 2; ++v)
        CHECK(f.q[v] - f.p[v] * y[v] == doctest::Approx(exact[v]).epsilon(1e-12));
      if (u < -0.2) continue;  // eps has a pole at -mu2
      const auto m = muscle.rates(y);
      const auto expected = aliev_panfilov(u, w);
      for (std::size_t v = 0; v < 2; ++v)
        CHECK(m.q[v] - m.p[v] * y[v] == doctest::Approx(expected[v]).epsilon(1e-12));
    }
  }
}

TEST_CASE("steps are of second order") {
  check_second_order(WithDefaults<AllenCahn>().model, std::array<double, 1>{0.1}, 4.0, 160);
  check_second_order(WithDefaults<FitzHughNagumo>().model, std::array<double, 2>{0.3, 0.0}, 60.0, 120);
  check_second_order(WithDefaults<AlievPanfilov>().model, std::array<double, 2>{0.4, 0.05}, 8.0, 160);
}

TEST_CASE("particles that cut their steps come close to the exact solution with long ones") {
  const WithDefaults<AlievPanfilov> defaults;
  const AlievPanfilov& model = defaults;
  const std::array<double, 2> start{0.2, 0.0};
  const ReactionIntegrator whole(interface_of(model), false), cut(interface_of(model), true);
  Cells a(whole, 5), b(cut, 5);
  for (Cells* cells : {&a, &b}) (*cells)[0].assign(8, start[0]);
  a.advance(0.0, 2.0);
  b.advance(0.0, 2.0);
  const double exact = runge_kutta(model, start, 2.0, 20000)[0];
  CHECK(std::fabs(a[0][0] - exact) > 0.1);  // 2 is 16 times the inverse rate of excitation
  CHECK(std::fabs(b[0][0] - exact) < 1e-3);
}

TEST_CASE("a particle does not notice who shares its block") {
  const WithDefaults<AlievPanfilov> defaults;
  const AlievPanfilov& model = defaults;
  const ReactionIntegrator integrator(interface_of(model));
  Cells many(integrator, 300);
  for (std::size_t i = 0; i < 300; ++i) many[0][i] = static_cast<double>(i) / 300.0;
  for (int k = 0; k < 20; ++k) many.advance(0.2 * k, 0.2);
  for (const std::size_t i : {0UL, 60UL, 61UL, 255UL, 256UL, 299UL}) {
    Cells alone(integrator, 1);
    alone[0][0] = static_cast<double>(i) / 300.0;
    for (int k = 0; k < 20; ++k) alone.advance(0.2 * k, 0.2);
    CHECK(alone[0][0] == many[0][i]);
    CHECK(alone[1][0] == many[1][i]);
  }
}

TEST_CASE("steps of 20 times the explicit limit stay within the bounds of the model") {
  // The limit 2 / |d(rate)/du| of an explicit step: at u = 1 the slopes are 2, 0.9 and 8 * 0.85.
  const auto range = [](const auto& model, double dt, double low, double high, bool adaptive) {
    const ReactionIntegrator integrator(interface_of(model), adaptive);
    Cells cells(integrator, 64);
    for (std::size_t i = 0; i < 64; ++i) cells[0][i] = low + (high - low) * static_cast<double>(i) / 63.0;
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (int k = 0; k < 200; ++k) {
      cells.advance(k * dt, dt);
      for (std::size_t i = 0; i < 64; ++i) {
        least = std::min(least, cells[0][i]);
        most = std::max(most, cells[0][i]);
      }
    }
    return std::array<double, 2>{least, most};
  };
  for (const bool adaptive : {false, true}) {
    const auto phases = range(WithDefaults<AllenCahn>().model, 20 * 2.0 / 2.0, -1.0, 1.0, adaptive);
    CHECK(phases[0] >= -1.0);
    CHECK(phases[1] <= 1.0);
    const auto muscle = range(WithDefaults<AlievPanfilov>().model, 20 * 2.0 / 6.8, 0.0, 1.0, adaptive);
    CHECK(muscle[0] >= 0.0);
    CHECK(muscle[1] <= 1.0);
    // Its recovery w pulls the potential below rest, to -0.16 in the exact solution. Whole steps, in which w does
    // not follow, overshoot, but do not grow.
    const auto nagumo = range(WithDefaults<FitzHughNagumo>().model, 20 * 2.0 / 0.9, 0.0, 1.0, adaptive);
    CHECK(nagumo[0] > (adaptive ? -0.5 : -20.0));
    CHECK(nagumo[1] <= (adaptive ? 1.0 : 20.0));
  }
}

TEST_CASE("Allen-Cahn moves to its phases without passing them, whatever the step") {
  const WithDefaults<AllenCahn> defaults;
  const AllenCahn& model = defaults;
  for (const double dt : {0.1, 1.0, 20.0, 1e4}) {
    const ReactionIntegrator integrator(interface_of(model), false);
    Cells cells(integrator, 16);
    for (std::size_t i = 0; i < 16; ++i) cells[0][i] = -1.9 + 0.25 * static_cast<double>(i);
    for (int k = 0; k < 30; ++k) {
      std::vector<double> before = cells[0];
      cells.advance(k * dt, dt);
      for (std::size_t i = 0; i < 16; ++i) {
        const auto energy = [](double u) { return 0.25 * (1 - u * u) * (1 - u * u); };
        CHECK(energy(cells[0][i]) <= energy(before[i]));
        CHECK(cells[0][i] * before[i] >= 0.0);
      }
    }
  }
}

TEST_CASE("the energy of Allen-Cahn falls at every step of reaction and diffusion") {
  // Drops and domains from noise on a periodic grid, split as in a run:  E = sum D |grad u|^2 / 2 + (1 - u^2)^2 / 4.
  constexpr std::size_t n = 48;
  const double d = 1.5;  // D / dx^2; the interface is about 3.5 spacings wide
  const WithDefaults<AllenCahn> defaults;
  const ReactionIntegrator integrator(interface_of<AllenCahn>(defaults));
  for (const double dt : {0.01, 0.1, 0.25}) {
    Cells cells(integrator, n * n);
    std::vector<double>& u = cells[0];
    std::uint64_t random = 1;
    for (double& value : u) {
      random = random * 6364136223846793005ULL + 1442695040888963407ULL;
      value = 0.4 * (static_cast<double>(random >> 40) / static_cast<double>(1 << 24) - 0.5);
    }
    const auto right = [](std::size_t i) { return i / n * n + (i + 1) % n; };
    const auto above = [](std::size_t i) { return (i + n) % (n * n); };
    const auto energy = [&] {
      double sum = 0;
      for (std::size_t i = 0; i < n * n; ++i)
        sum += 0.5 * d * (std::pow(u[right(i)] - u[i], 2) + std::pow(u[above(i)] - u[i], 2)) +
               0.25 * std::pow(1 - u[i] * u[i], 2);
      return sum;
    };
    const auto rates = [&](const std::vector<double>& c) {
      std::vector<double> rate(c.size(), 0.0);
      for (std::size_t i = 0; i < n * n; ++i)
        for (const std::size_t j : {right(i), above(i)}) {
          rate[i] += d * (c[j] - c[i]);
          rate[j] += d * (c[i] - c[j]);
        }
      return rate;
    };
    const double first = energy();
    double last = first;
    int risen = 0;
    for (int k = 0; k < 400; ++k) {
      cells.advance(k * dt, 0.5 * dt);
      const int parts = 1 + static_cast<int>(8 * d * dt / 1.5);
      for (int part = 0; part < parts; ++part) {
        const std::vector<double> a = rates(u);
        std::vector<double> middle = u;
        for (std::size_t i = 0; i < n * n; ++i) middle[i] += dt / parts * a[i];
        const std::vector<double> b = rates(middle);
        for (std::size_t i = 0; i < n * n; ++i) u[i] += 0.5 * dt / parts * (a[i] + b[i]);
      }
      cells.advance(k * dt, 0.5 * dt);
      const double now = energy();
      risen += now > last;
      last = now;
    }
    CAPTURE(dt);
    CHECK(risen == 0);
    CHECK(last < 0.8 * first);
  }
}

TEST_CASE("a source adds to the first variable") {
  Constant model;
  model.p = 0.5;
  const ReactionIntegrator integrator(interface_of(model));
  Cells cells(integrator, 2);
  const std::vector<double> source{0.0, 3.0};
  cells.advance(0.0, 0.4, source.data());
  CHECK(cells[0][0] == doctest::Approx(std::exp(-0.2)));
  CHECK(cells[0][1] == doctest::Approx(std::exp(-0.2) + 6.0 * (1 - std::exp(-0.2))));
}
