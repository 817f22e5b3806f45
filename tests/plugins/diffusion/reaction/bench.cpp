// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The ventricular cell in packs against the same source in plain numbers, one cell after the other, and against the
// equations as they are printed. Processor time, the least of several turns.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <ctime>

#include "cells.hpp"
#include "plain_ten_tusscher.hpp"
#include "ten_tusscher_panfilov.hpp"

using namespace shoal;
using namespace shoal::diffusion;
using namespace shoal::diffusion::test;

namespace {

constexpr std::size_t n_cells = 4096;

double processor_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <class Work>
double least_time(Work&& work) {
  double least = HUGE_VAL;
  for (int turn = 0; turn < 7; ++turn) {
    const double begin = processor_seconds();
    work();
    least = std::min(least, processor_seconds() - begin);
  }
  return least;
}

// Rates of all cells one after the other.
double scalar_rates(const TenTusscherPanfilov& model, const std::vector<std::vector<double>>& y) {
  double sum = 0;
  for (std::size_t i = 0; i < n_cells; ++i) {
    std::array<double, tt06::n_variables> state;
    for (std::size_t v = 0; v < state.size(); ++v) state[v] = y[v][i];
    const auto rates = model.rates(state);
    for (std::size_t v = 0; v < state.size(); ++v) sum += rates.q[v] + rates.p[v];
  }
  return sum;
}

// The same by the printed equations.
double plain_sum(const std::vector<std::vector<double>>& y) {
  double sum = 0;
  for (std::size_t i = 0; i < n_cells; ++i) {
    PlainState state;
    for (std::size_t v = 0; v < state.size(); ++v) state[v] = y[v][i];
    for (const double rate : plain_rates(state, "epi")) sum += rate;
  }
  return sum;
}

}  // namespace

TEST_CASE("rates of the ventricular cell: packs against numbers") {
  const TenTusscherPanfilov model;
  const auto interface = interface_of(model);
  std::vector<std::vector<double>> y, q(tt06::n_variables), p(tt06::n_variables);
  std::vector<const double*> y_at;
  std::vector<double*> q_at, p_at;
  for (const ReactionVariable& variable : model.variables()) y.emplace_back(n_cells, variable.initial);
  for (std::size_t i = 0; i < n_cells; ++i) y[0][i] = -0.09001 + 0.12 * static_cast<double>(i) / n_cells;
  for (std::size_t v = 0; v < y.size(); ++v) {
    q[v].resize(n_cells);
    p[v].resize(n_cells);
    y_at.push_back(y[v].data());
    q_at.push_back(q[v].data());
    p_at.push_back(p[v].data());
  }
  const double packs = least_time([&] {
    interface.api->rates(interface.self, 3, 0.0, n_cells, nullptr, y_at.data(), q_at.data(), p_at.data());
  });
  double scalar_sum = 0, pack_sum = 0;
  const double scalar = least_time([&] { scalar_sum = scalar_rates(model, y); });
  for (std::size_t i = 0; i < n_cells; ++i)
    for (std::size_t v = 0; v < y.size(); ++v) pack_sum += q[v][i] + p[v][i];
  CHECK(pack_sum == doctest::Approx(scalar_sum).epsilon(1e-10));
  std::printf("rates of ten Tusscher-Panfilov: packs %.0f ns, numbers %.0f ns a cell, ratio %.1f\n",
              1e9 * packs / n_cells, 1e9 * scalar / n_cells, scalar / packs);
  double rates_of_plain = 0;
  const double plain = least_time([&] { rates_of_plain = plain_sum(y); });
  CHECK(std::isfinite(rates_of_plain));
  std::printf("the equations as they are printed: %.0f ns a cell, ratio %.1f\n", 1e9 * plain / n_cells,
              plain / packs);
  CHECK(scalar > 2.0 * packs);  // the figure is what is printed; this only notices that packs are lost

  const ReactionIntegrator integrator(interface);
  Cells cells(integrator, n_cells);
  const double step = least_time([&] { cells.advance(0.0, 1e-5); });
  std::printf("a step of second order: %.0f ns a cell\n", 1e9 * step / n_cells);
}
