// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Small scenes of each plugin. Their lengths are multiples of S, and what drives them grows with S so that their times
// stay the same: gravity with S, elastic moduli and diffusivities with S^2.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "tests/app/support.hpp"

namespace stability {

using app_test::contains;
using app_test::read;
using app_test::Result;
using app_test::rows;
using app_test::shoal;
using app_test::write;

inline const std::string dam_break =
    "shoal: 1\n"
    "plugins: [fluid]\n"
    "dimensions: 2\n"
    "parameters: {S: 1, dx: 0.04*S}\n"
    "resolution: $dx\n"
    "gravity: [0, -10*S]\n"
    "bodies:\n"
    "  water:\n"
    "    shape: {box: {lower: [0, 0], upper: [S, 0.6*S]}}\n"
    "    material: {fluid.liquid: {density: 1000, viscosity: 1000*1e-4*S^2}}\n"
    "  tank:\n"
    "    shape: {shell: {of: {box: {lower: [0, 0], upper: [2*S, 1.2*S]}}, thickness: 4*dx}}\n"
    "    material: fluid.wall\n"
    "physics:\n"
    "  - fluid.wcsph: {bodies: [water], walls: [tank]}\n"
    "run: {end: 0.8}\n"
    "probes:\n"
    "  lengths: {maximum: {of: [position.x, position.y], body: water}, every: 20 ms}\n"
    "  energy:\n"
    "    sum: {of: [\"0.5*mass*velocity.magnitude^2/S^4\", \"mass*10*S*position.y/S^4\"], body: water}\n"
    "    every: 20 ms\n";

inline const std::string vortices =
    "shoal: 1\n"
    "plugins: [fluid]\n"
    "dimensions: 2\n"
    "parameters: {S: 1, dx: S/20}\n"
    "resolution: $dx\n"
    "domain: {lower: [0, 0], upper: [S, S], periodic: [x, y]}\n"
    "bodies:\n"
    "  water:\n"
    "    shape: {box: {lower: [0, 0], upper: [S, S]}}\n"
    "    material: {fluid.liquid: {density: 1, viscosity: 0.01*S^2}}\n"
    "    initial:\n"
    "      velocity: [\"S*sin(2*pi*x/S)*cos(2*pi*y/S)\", \"-S*cos(2*pi*x/S)*sin(2*pi*y/S)\"]\n"
    "physics:\n"
    "  - fluid.least_squares: {bodies: [water], max_speed: S}\n"
    "run: {end: 0.2}\n"
    "probes:\n"
    "  lengths: {maximum: {of: [velocity.x, velocity.y], body: water}, every: 20 ms}\n"
    "  energy: {sum: {of: \"0.5*mass*velocity.magnitude^2/S^4\", body: water}, every: 20 ms}\n";

// Swings in its first mode, clamped on the left.
inline const std::string plate =
    "shoal: 1\n"
    "plugins: [solid]\n"
    "dimensions: 2\n"
    "parameters: {S: 1, dx: 0.02*S}\n"
    "resolution: $dx\n"
    "domain: {lower: [-S, -3*S], upper: [3*S, 3*S]}\n"
    "bodies:\n"
    "  plate:\n"
    "    shape: {box: {lower: [0, 0], upper: [S, 0.12*S]}}\n"
    "    material: {solid.neo_hookean: {density: 1000, youngs_modulus: 2e6*S^2, poisson_ratio: 0.4}}\n"
    "    initial: {velocity: [0, \"5*S*(x/S)^2\"]}\n"
    "physics:\n"
    "  - solid.total_lagrangian: {bodies: [plate]}\n"
    "  - solid.clamp: {bodies: [plate], where: x < 2*dx}\n"
    "run: {end: 0.2}\n"
    "probes:\n"
    "  lengths: {maximum: {of: [position.x, position.y], body: plate}, every: 2 ms}\n"
    "  energy:\n"
    "    sum: {of: [\"0.5*mass*velocity.magnitude^2/S^4\", \"volume*strain_energy/S^4\"], body: plate}\n"
    "    every: 2 ms\n";

// A hot spot beside a cold wall.
inline const std::string heat =
    "shoal: 1\n"
    "plugins: [diffusion]\n"
    "dimensions: 2\n"
    "parameters: {S: 1, dx: 0.05*S}\n"
    "resolution: $dx\n"
    "bodies:\n"
    "  plate:\n"
    "    shape: {box: {lower: [0, 0], upper: [S, S]}}\n"
    "    arrangement: relaxed\n"
    "    material: {diffusion.medium: {diffusivity: 0.01*S^2}}\n"
    "    initial: {concentration: \"exp(-((x/S - 0.3)^2 + (y/S - 0.5)^2)/0.02)\"}\n"
    "physics:\n"
    "  - diffusion.diffusion: {bodies: [plate], fields: [concentration], integrator: rk2}\n"
    "run: {end: 1}\n"
    "probes:\n"
    "  lengths: {maximum: {of: [concentration, position.x], body: plate}, every: 50 ms}\n"
    "  energy: {sum: {of: [\"concentration*volume/S^2\", \"concentration^2*volume/S^2\"], body: plate}, "
    "every: 50 ms}\n";

// Runs a scene with more arguments.
inline Result run(const std::string& scene, const std::string& output, std::vector<std::string> more = {}) {
  write(output + ".yaml", scene);
  std::vector<std::string> arguments{"run", output + ".yaml", "-o", output, "--force", "--threads", "1"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return shoal(arguments);
}

inline std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const auto at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), with);
}

}  // namespace stability
