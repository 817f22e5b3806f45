// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The ventricular cell: its rates against the equations of the paper written out plainly, and its action potential.
#include "ten_tusscher_panfilov.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "cells.hpp"
#include "plain_ten_tusscher.hpp"

using namespace shoal;
using namespace shoal::diffusion;
using namespace shoal::diffusion::test;

namespace {

using State = PlainState;

State at_rest(const TenTusscherPanfilov& model) {
  State y{};
  const auto variables = model.variables();
  for (std::size_t v = 0; v < y.size(); ++v) y[v] = variables[v].initial;
  return y;
}

struct ActionPotential {
  double rest, peak, duration;  // mV, mV, ms at 90 % of repolarisation
};

// Paced at 1 Hz by 52 mV/ms for 1 ms; the last of `beats`.
ActionPotential pace(const char* cell, double dt, int beats) {
  TenTusscherPanfilov model;
  model.cell = Choice{cell};
  model.check();
  const ReactionIntegrator integrator(interface_of(model));
  Cells cells(integrator, 1);
  ActionPotential out{};
  const int steps = static_cast<int>(std::lround(1.0 / dt)), on = static_cast<int>(std::lround(1e-3 / dt));
  std::vector<double> v;
  for (int beat = 0; beat < beats; ++beat) {
    v.assign(1, cells[0][0]);
    for (int k = 0; k < steps; ++k) {
      const double source = k < on ? 52.0 : 0.0;
      cells.advance(beat + k * dt, dt, &source);
      v.push_back(cells[0][0]);
    }
  }
  out.rest = 1e3 * v[0];
  const auto top = std::max_element(v.begin(), v.end());
  out.peak = 1e3 * *top;
  const auto up = std::find_if(v.begin(), v.end(), [](double x) { return x > 0.0; });
  const auto down = std::find_if(top, v.end(), [&](double x) { return x < v[0] + 0.1 * (*top - v[0]); });
  out.duration = 1e3 * dt * static_cast<double>(down - up);
  return out;
}

}  // namespace

TEST_CASE("rates in packs and in numbers equal those of the equations written out plainly") {
  for (const char* cell : {"epi", "endo", "mid"}) {
    TenTusscherPanfilov model;
    model.cell = Choice{cell};
    model.check();
    const State rest = at_rest(model);
    for (double v = -0.1; v < 0.061; v += 0.0027) {
      State y = rest;
      y[0] = v;
      // Somewhere in the middle of what the other variables do.
      const double s = 0.5 + 0.4 * std::sin(90.0 * v);
      for (std::size_t g = 1; g <= 13; ++g) y[g] = 0.3 * y[g] + 0.7 * s;
      y[14] *= 1.0 + 5.0 * s;
      y[15] *= 1.0 + 500.0 * s;
      y[16] *= 0.5 + s;
      const State expected = plain_rates(y, cell);
      const auto numbers = model.rates(y);
      std::array<Pack, tt06::n_variables> packed;
      for (std::size_t k = 0; k < y.size(); ++k) packed[k] = Pack(y[k]);
      const auto packs = model.rates(packed);
      for (std::size_t k = 0; k < y.size(); ++k) {
        CAPTURE(cell);
        CAPTURE(v);
        CAPTURE(k);
        const double scale = std::fabs(numbers.q[k]) + std::fabs(numbers.p[k] * y[k]);
        CHECK(std::fabs(numbers.q[k] - numbers.p[k] * y[k] - expected[k]) < 1e-11 * scale);
        CHECK(std::fabs(packs.q[k][lanes - 1] - numbers.q[k]) <= 1e-12 * std::fabs(numbers.q[k]));
        CHECK(std::fabs(packs.p[k][0] - numbers.p[k]) <= 1e-12 * std::fabs(numbers.p[k]));
      }
    }
  }
}

TEST_CASE("the L-type current has its limit at 15 mV, where the printed formula is 0 / 0") {
  TenTusscherPanfilov model;
  State y = at_rest(model);
  y[tt06::d] = 0.5;
  const auto rate = [&](double v) {
    y[0] = v;
    const auto r = model.rates(y);
    return r.q[tt06::Ca_ss] - r.p[tt06::Ca_ss] * y[tt06::Ca_ss];
  };
  CHECK(std::isfinite(rate(0.015)));
  CHECK(rate(0.015) == doctest::Approx(0.5 * (rate(0.015 - 1e-7) + rate(0.015 + 1e-7))).epsilon(1e-8));
}

TEST_CASE("lanes on both sides of -40 mV get their own branch of the sodium gates") {
  const TenTusscherPanfilov model;
  std::array<Pack, tt06::n_variables> packed;
  const State rest = at_rest(model);
  for (std::size_t k = 0; k < rest.size(); ++k) packed[k] = Pack(rest[k]);
  packed[0].set(1, 0.02);
  packed[0].set(2, -0.04);
  const auto packs = model.rates(packed);
  for (int lane = 0; lane < lanes; ++lane) {
    State y = rest;
    y[0] = packed[0][lane];
    const auto numbers = model.rates(y);
    for (const std::size_t gate : {2U, 3U})
      CHECK(packs.p[gate][lane] == doctest::Approx(numbers.p[gate]).epsilon(1e-12));
  }
}

TEST_CASE("the action potential has the rest, the peak and the duration of the paper") {
  // The paper's figures at 1 Hz: rest near -85 mV, peak 35 to 40 mV, about 300 ms in epicardium and endocardium and
  // about 400 ms in M cells, whose slow delayed rectifier is a quarter of theirs.
  const ActionPotential epi = pace("epi", 1e-4, 2), endo = pace("endo", 1e-4, 2), mid = pace("mid", 1e-4, 2);
  MESSAGE("epi: rest " << epi.rest << " mV, peak " << epi.peak << " mV, APD90 " << epi.duration << " ms");
  MESSAGE("endo: rest " << endo.rest << " mV, peak " << endo.peak << " mV, APD90 " << endo.duration << " ms");
  MESSAGE("mid: rest " << mid.rest << " mV, peak " << mid.peak << " mV, APD90 " << mid.duration << " ms");
  for (const ActionPotential& one : {epi, endo, mid}) {
    CHECK(one.rest > -86.5);
    CHECK(one.rest < -84.5);
    CHECK(one.peak > 33.0);
    CHECK(one.peak < 42.0);
  }
  CHECK(std::fabs(epi.duration - 300.0) < 15.0);
  CHECK(std::fabs(endo.duration - 300.0) < 15.0);
  CHECK(mid.duration > epi.duration + 60.0);
}

TEST_CASE("the action potential converges with second order in time") {
  // Without steps of the cell's own: the potential 10 ms after the end of the stimulus.
  const TenTusscherPanfilov model;
  const ReactionIntegrator integrator(interface_of(model), false);
  const auto potential = [&](double dt) {
    Cells cells(integrator, 1);
    for (int k = 0; k < std::lround(1e-2 / dt); ++k) {
      const double source = k < std::lround(1e-3 / dt) ? 52.0 : 0.0;
      cells.advance(k * dt, dt, &source);
    }
    return cells[0][0];
  };
  const double exact = potential(2.5e-7);
  const double coarse = std::fabs(potential(2e-5) - exact), fine = std::fabs(potential(1e-5) - exact),
               finest = std::fabs(potential(5e-6) - exact);
  CHECK(coarse < 1e-4);
  CHECK(std::log2(coarse / fine) > 1.7);
  CHECK(std::log2(fine / finest) > 1.8);
}
