// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The ventricular cell in packs against plain numbers, one cell after the other, whatever of these is fastest: the same
// source with the exponentials of the C library, the same with the plugin's own, and the equations as they are printed.
// Rates, and whole steps of second order. Processor time, the least of several turns; blocks of 32 aligned cells, as
// the plugin works through them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "aliev_panfilov.hpp"
#include "cells.hpp"
#include "fitzhugh_nagumo.hpp"
#include "number.hpp"
#include "plain_ten_tusscher.hpp"
#include "ten_tusscher_panfilov.hpp"

using namespace shoal;
using namespace shoal::diffusion;
using namespace shoal::diffusion::test;

namespace {

constexpr std::size_t n_cells = 2048, block = 32, n_variables = tt06::n_variables;
using Columns = std::vector<std::vector<double>>;

double processor_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Of each piece of work, in turns, so that all see the same machine.
template <class... Work>
std::array<double, sizeof...(Work)> least_ns_per_cell(Work&&... work) {
  std::array<double, sizeof...(Work)> least;
  least.fill(HUGE_VAL);
  for (int turn = 0; turn < 25; ++turn) {
    std::size_t k = 0;
    const auto measure = [&](auto& one) {
      const double begin = processor_seconds();
      one();
      const double ns = 1e9 * (processor_seconds() - begin) / n_cells;
      least[k] = std::min(least[k], ns);
      ++k;
    };
    (measure(work), ...);
  }
  return least;
}

// Cells from rest to the peak of the action potential.
Columns all_cells(const TenTusscherPanfilov& model) {
  Columns y;
  for (const ReactionVariable& variable : model.variables()) y.emplace_back(n_cells, variable.initial);
  for (std::size_t i = 0; i < n_cells; ++i) y[0][i] = -0.09001 + 0.12 * static_cast<double>(i) / n_cells;
  return y;
}

template <class R>
std::array<R, n_variables> state_of(const Columns& y, std::size_t i) {
  std::array<R, n_variables> state;
  for (std::size_t v = 0; v < state.size(); ++v) state[v] = R(y[v][i]);
  return state;
}

// Sum of all q and p of all cells, one after the other.
template <class R>
double sum_of_rates(const TenTusscherPanfilov& model, const Columns& y) {
  R sum(0.0);
  for (std::size_t i = 0; i < n_cells; ++i) {
    const auto rates = model.rates(state_of<R>(y, i));
    for (std::size_t v = 0; v < n_variables; ++v) sum = sum + rates.q[v] + rates.p[v];
  }
  return static_cast<double>(sum);
}

double sum_of_printed(const Columns& y) {
  double sum = 0;
  for (std::size_t i = 0; i < n_cells; ++i)
    for (const double rate : plain_rates(state_of<double>(y, i), "epi")) sum += rate;
  return sum;
}

// A step of the integrator in plain numbers, without steps that cells cut by themselves.
void plain_step(const TenTusscherPanfilov& model, Columns& y, double dt) {
  for (std::size_t i = 0; i < n_cells; ++i) {
    const auto start = state_of<Number>(y, i);
    const auto first = model.rates(start);
    std::array<Number, n_variables> middle;
    for (std::size_t v = 0; v < n_variables; ++v) {
      const double p = first.p[v].x, slope = first.q[v].x - p * start[v].x;
      middle[v] = Number(start[v].x + 0.5 * dt * slope / (1.0 + 0.5 * dt * std::max(0.0, p)));
    }
    const auto rates = model.rates(middle);
    for (std::size_t v = 0; v < n_variables; ++v) {
      const double z = rates.p[v].x * dt, decay = std::exp(-z);
      const double mean = std::fabs(z) < 1e-5 ? 1.0 - 0.5 * z : (1.0 - decay) / z;
      y[v][i] = start[v].x * decay + rates.q[v].x * dt * mean;
    }
  }
}

// q and p of a block, aligned as the integrator's.
struct BlockRates {
  alignas(64) double q[n_variables][block], p[n_variables][block];
  double *q_at[n_variables], *p_at[n_variables];
  BlockRates() {
    for (std::size_t v = 0; v < n_variables; ++v) q_at[v] = q[v], p_at[v] = p[v];
  }
};

}  // namespace

TEST_CASE("rates of the ventricular cell: packs against numbers") {
  const TenTusscherPanfilov model;
  const auto interface = interface_of(model);
  const Columns y = all_cells(model);
  static BlockRates rates;
  double pack_sum = 0;
  const auto packs_of = [&](bool add_up) {
    std::array<const double*, n_variables> at;
    for (std::size_t first = 0; first < n_cells; first += block) {
      for (std::size_t v = 0; v < n_variables; ++v) at[v] = y[v].data() + first;
      interface.api->rates(interface.self, 3, 0.0, block, nullptr, at.data(), rates.q_at, rates.p_at);
      for (std::size_t v = 0; add_up && v < n_variables; ++v)
        for (std::size_t i = 0; i < block; ++i) pack_sum += rates.q[v][i] + rates.p[v][i];
    }
  };
  packs_of(true);
  double sum = 0, own_sum = 0, printed_sum = 0;
  const auto [packs, library, own, printed] = least_ns_per_cell(
      [&] { packs_of(false); }, [&] { sum = sum_of_rates<Number>(model, y); },
      [&] { own_sum = sum_of_rates<double>(model, y); }, [&] { printed_sum = sum_of_printed(y); });
  CHECK(pack_sum == doctest::Approx(sum).epsilon(1e-10));
  CHECK(own_sum == doctest::Approx(sum).epsilon(1e-10));
  CHECK(std::isfinite(printed_sum));
  const double numbers = std::min({library, own, printed});
  std::printf(
      "rates of ten Tusscher-Panfilov, ns a cell: packs of %d %.0f; numbers %.0f (exponentials of the "
      "library), %.0f (own), as printed %.0f; ratio %.1f\n",
      lanes, packs, library, own, printed, numbers / packs);
  CHECK(numbers > (lanes == 8 ? 4.0 : 2.0) * packs);
}

template <class Model>
void print_step(const char* name, const Model& model) {
  const ReactionIntegrator integrator(interface_of(model));
  Cells cells(integrator, n_cells);
  const auto [ns] = least_ns_per_cell([&] { cells.advance(0.0, 1e-5); });
  std::printf("a step of %s: %.1f ns a cell, %.1f for each variable\n", name, ns,
              ns / static_cast<double>(integrator.n_variables()));
}

TEST_CASE("what steps cost, for plugins/diffusion/cost.hpp") {
  print_step("ten Tusscher-Panfilov", TenTusscherPanfilov());
  print_step("Aliev-Panfilov", WithDefaults<AlievPanfilov>().model);
  print_step("FitzHugh-Nagumo", WithDefaults<FitzHughNagumo>().model);
}

TEST_CASE("steps of the ventricular cell: packs against numbers") {
  const TenTusscherPanfilov model;
  const ReactionIntegrator integrator(interface_of(model), false);
  Cells cells(integrator, n_cells);
  Columns y = all_cells(model);
  for (std::size_t v = 0; v < n_variables; ++v) std::copy(y[v].begin(), y[v].end(), cells[v].begin());
  const auto [packs, numbers] =
      least_ns_per_cell([&] { cells.advance(0.0, 1e-5); }, [&] { plain_step(model, y, 1e-5); });
  double worst = 0;
  for (std::size_t i = 0; i < n_cells; ++i) worst = std::max(worst, std::fabs(cells[0][i] - y[0][i]));
  CHECK(worst < 1e-9);  // V
  std::printf("steps of second order, ns a cell: packs of %d %.0f, numbers %.0f, ratio %.1f\n", lanes, packs,
              numbers, numbers / packs);
  CHECK(numbers > (lanes == 8 ? 4.0 : 2.0) * packs);
}
