// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The step of each scheme is made longer until the scheme fails. What is measured is the first factor on the default
// at which it does; the default must hold on all scenes, and the table is what docs/stability.md shows.
#include <cstdio>

#include "tests/stability/scenes.hpp"

using namespace stability;

namespace {

// Whether the run ends, with finite energies whose sum never exceeds that of the start by more than 2 %.
bool holds(const std::string& scene, const std::string& set) {
  const Result result = run(scene, "limit", {"--set", set});
  if (result.code != 0) return false;
  const auto table = rows("limit/probes/energy.csv");
  if (table.size() < 5) return false;
  const auto total = [](const std::vector<double>& row) {
    double sum = 0;
    for (std::size_t c = 1; c < row.size(); ++c) sum += row[c];
    return sum;
  };
  for (const auto& row : table)
    if (!(total(row) <= 1.02 * total(table.front()))) return false;
  return true;
}

// The largest factor in steps of 5 % at which the scheme holds, at most 3.
double limit_of(const char* name, const std::string& scene, const std::string& key, double standard,
                double largest = 3.0) {
  const auto at = [&](double factor) {
    char set[128];
    std::snprintf(set, sizeof set, "%s=%.6g", key.c_str(), factor * standard);
    return holds(scene, set);
  };
  double good = 0.0;
  for (double factor = 1.0; factor <= largest; factor *= 1.1) {
    if (!at(factor)) break;
    good = factor;
  }
  std::printf("%-44s %-16s default %6.3g  holds to %6.3g\n", name, key.substr(key.rfind('.') + 1).c_str(),
              standard, good * standard);
  return good;
}

}  // namespace

TEST_CASE("the longest stable steps") {
  const std::string disordered_dam = replaced(dam_break, "    material: {fluid.liquid",
                                              "    arrangement: relaxed\n    material: {fluid.liquid");
  const std::string disordered_plate =
      replaced(plate, "    material: {solid", "    arrangement: relaxed\n    material: {solid");
  const std::string disordered_vortices = replaced(vortices, "    material: {fluid.liquid",
                                                   "    arrangement: relaxed\n    material: {fluid.liquid");
  CHECK(limit_of("fluid.wcsph, dam break", dam_break, "physics.0.fluid.wcsph.acoustic_cfl", 0.6) >= 1.0);
  CHECK(limit_of("fluid.wcsph, dam break, disordered", disordered_dam, "physics.0.fluid.wcsph.acoustic_cfl",
                 0.6) >= 1.0);
  CHECK(limit_of("fluid.wcsph, dam break", dam_break, "physics.0.fluid.wcsph.advection_cfl", 0.25) >= 1.0);
  CHECK(limit_of("fluid.least_squares, vortices, disordered", disordered_vortices,
                 "physics.0.fluid.least_squares.acoustic_cfl", 0.6) >= 1.0);
  CHECK(limit_of("fluid.least_squares, vortices, disordered", disordered_vortices,
                 "physics.0.fluid.least_squares.advection_cfl", 0.25) >= 1.0);
  CHECK(limit_of("solid.total_lagrangian, plate", plate, "physics.0.solid.total_lagrangian.step_factor", 0.95,
                 1.05) >= 1.0);
  CHECK(limit_of("solid.total_lagrangian, plate, disordered", disordered_plate,
                 "physics.0.solid.total_lagrangian.step_factor", 0.95, 1.05) >= 1.0);
  // Modes that grow start from nothing: in a hundred steps they show.
  const std::string long_heat = replaced(heat, "run: {end: 1}", "run: {end: 40}");
  CHECK(limit_of("diffusion rk2, disordered plate", long_heat, "physics.0.diffusion.diffusion.cfl", 0.9) >=
        1.0);
}
