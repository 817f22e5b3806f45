// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A hundred times longer than the scenes are meant for: what is conserved must not drift, what dissipates must rest.
#include "tests/stability/scenes.hpp"

using namespace stability;

TEST_CASE("a plate swings a hundred periods and keeps its energy") {
  // No damping is asked for, so the energy is that of the start but for the oscillation of the symplectic scheme,
  // which is of second order in the step and bounded (a period is 1.06 s).
  const Result result = run(plate, "plate", {"--set", "run.end=110", "--set", "probes.energy.every=0.5"});
  REQUIRE_MESSAGE(result.code == 0, result.err);
  const auto energy = rows("plate/probes/energy.csv");
  const double start = energy.front()[1] + energy.front()[2];
  double lowest = start, highest = start;
  for (const auto& row : energy) {
    lowest = std::min(lowest, row[1] + row[2]);
    highest = std::max(highest, row[1] + row[2]);
  }
  MESSAGE("energy between " << lowest / start << " and " << highest / start << " of that of the start");
  CHECK(highest < 1.01 * start);
  CHECK(lowest > 0.95 * start);
}

TEST_CASE("heat in a closed plate is kept for a hundred times its spreading") {
  // The scheme that conserves does so to rounding: 1e-16 a step and particle, in 1e5 steps.
  const Result result = run(replaced(heat, "integrator: rk2", "integrator: rk2, scheme: conservative"),
                            "heat", {"--set", "run.end=100", "--set", "probes.energy.every=1"});
  REQUIRE_MESSAGE(result.code == 0, result.err);
  const auto sums = rows("heat/probes/energy.csv");
  for (const auto& row : sums) CHECK(std::abs(row[1] / sums.front()[1] - 1.0) < 1e-10);
  // and is spread evenly in the end: mean of the square = square of the mean
  CHECK(sums.back()[2] == doctest::Approx(sums.back()[1] * sums.back()[1]).epsilon(1e-9));
}

TEST_CASE("water in a tank comes to rest and stays there") {
  const std::string rest = replaced(dam_break, "upper: [S, 0.6*S]", "upper: [2*S, 0.6*S]");
  const Result result = run(rest, "rest", {"--set", "run.end=80", "--set", "probes.energy.every=1"});
  REQUIRE_MESSAGE(result.code == 0, result.err);
  const auto energy = rows("rest/probes/energy.csv");
  const double potential = energy.front()[2];
  double late = 0;
  for (const auto& row : energy)
    if (row[0] > 40) late = std::max(late, row[1] / potential);
  MESSAGE("kinetic over potential energy after 40 s: at most " << late);
  CHECK(late < 1e-6);
  CHECK(energy.back()[2] == doctest::Approx(potential).epsilon(0.01));
}
