// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The program with a real physics: a small dam break that is interrupted, that runs on other numbers of threads, and
// of which only what is used is there.
#include <cmath>

#include "tests/app/support.hpp"

using namespace app_test;

namespace {

const std::string dam =
    "shoal: 1\n"
    "plugins: [fluid]\n"
    "dimensions: 2\n"
    "parameters: {dx: 20 mm}\n"
    "resolution: $dx\n"
    "gravity: [0, -9.81]\n"
    "bodies:\n"
    "  water:\n"
    "    shape: {box: {lower: [0, 0], upper: [0.6, 0.4]}}\n"
    "    material: {fluid.liquid: {density: 1000}}\n"
    "  tank:\n"
    "    shape: {shell: {of: {box: {lower: [0, 0], upper: [1, 0.6]}}, thickness: 4*dx}}\n"
    "    material: fluid.wall\n"
    "physics:\n"
    "  - fluid.wcsph: {bodies: [water], walls: [tank]}\n"
    "run: {end: 0.3}\n"
    "probes:\n"
    "  front: {maximum: {of: position.x, body: water}, every: 2 ms}\n"
    "  energy: {sum: {of: 0.5*mass*velocity.magnitude^2, body: water}, every: 2 ms}\n"
    "  load: {sum: {of: [force.x, force.y], body: tank}, every: 2 ms}\n"
    "  bottom: {point: {of: pressure, at: [0.1, 0], body: water}, every: 2 ms}\n";

void check_same(const std::string& a, const std::string& b) {
  for (const char* probe : {"front", "energy", "load", "bottom"}) {
    const std::string table = read(a + "/probes/" + probe + ".csv");
    CHECK(table.size() > 1000);
    CHECK(table == read(b + "/probes/" + probe + ".csv"));
  }
}

}  // namespace

TEST_CASE("a dam break: interrupted or not, on one thread or two, bitwise the same") {
  write("dam.yaml", dam);
  REQUIRE(shoal({"run", "dam.yaml", "-o", "whole", "--force", "--threads", "1"}).code == 0);
  REQUIRE(shoal({"run", "dam.yaml", "-o", "parts", "--force", "--until", "0.11", "--threads", "2"}).code ==
          0);
  REQUIRE(shoal({"resume", "parts", "--steps", "20", "--threads", "2"}).code == 0);
  REQUIRE(shoal({"resume", "parts", "--threads", "2"}).code == 0);
  check_same("whole", "parts");
}

TEST_CASE("the force on the tank is what changes the momentum of the water") {
  // Newton's third law over the run: p(t) = g m t - int F dt, up to the sum over the steps at which the force is
  // sampled, at the end of each. Steps of advection are as short as acoustic ones, so that no sound passes between samples.
  // Corrections of the density at the beginning of steps send sound through the water; if they were sudden, the force of
  // each would be over before it is sampled, and the error would not converge.
  std::string text = dam.substr(0, dam.find("probes:")) +
                     "probes:\n"
                     "  momentum: {sum: {of: [mass*velocity.x, mass*velocity.y], body: water}, every: 1 us}\n"
                     "  load: {sum: {of: [force.x, force.y], body: tank}, every: 1 us}\n";
  write("balance.yaml", text);
  const double weight = 0.6 * 0.4 * 1000 * 9.81;
  std::vector<double> errors;
  for (const char* dx : {"dx=20 mm", "dx=10 mm"}) {
    REQUIRE(shoal({"run", "balance.yaml", "-o", "balance", "--force", "--set", dx, "--set", "run.end=0.2",
                   "--set", "physics.0.fluid.wcsph.advection_cfl=0.08"})
                .code == 0);
    const auto momentum = rows("balance/probes/momentum.csv"), load = rows("balance/probes/load.csv");
    double x = 0.0, y = 0.0;
    for (std::size_t k = 1; k < load.size(); ++k) {
      const double dt = load[k][0] - load[k - 1][0];
      x += 0.5 * dt * (load[k][1] + load[k - 1][1]);
      y += 0.5 * dt * (load[k][2] + load[k - 1][2]);
    }
    const double impulse = weight * momentum.back()[0];
    errors.push_back(std::hypot(momentum.back()[1] + x, momentum.back()[2] + y + impulse) / impulse);
    MESSAGE(std::string(dx) << ": momentum and impulse differ by " << errors.back()
                            << " of the weight's impulse");
  }
  CHECK(errors[0] < 1.5e-3);
  CHECK(errors[1] < 0.5 * errors[0]);
}

TEST_CASE("without viscosity there is no viscous operator; the force on the tank is computed on demand") {
  write("dam.yaml", dam);
  const Result result = shoal({"plan", "dam.yaml"});
  REQUIRE(result.code == 0);
  CHECK_FALSE(contains(result.out, "viscous"));
  CHECK(contains(result.out, "wall_force  on tank"));
}
