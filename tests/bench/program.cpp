// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/program.hpp"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

namespace shoal::bench {
namespace {

// 2 x 1 x 1 m of water; without probes and outputs, so that nothing but steps is measured.
std::string dam_break(double dx) {
  std::ostringstream text;
  text << "shoal: 1\n"
          "title: Dam break of the benchmark\n"
          "plugins: [fluid]\n"
          "dimensions: 3\n"
          "parameters: {dx: "
       << dx
       << "}\n"
          "resolution: $dx\n"
          "gravity: [0, 0, -9.81]\n"
          "bodies:\n"
          "  water:\n"
          "    shape: {box: {lower: [0, 0, 0], upper: [2, 1, 1]}}\n"
          "    material: {fluid.liquid: {density: 1000}}\n"
          "  tank:\n"
          "    shape: {shell: {of: {box: {lower: [0, 0, 0], upper: [3, 1, 1.5]}}, thickness: 3*dx}}\n"
          "    material: fluid.wall\n"
          "physics:\n"
          "  - fluid.wcsph: {bodies: [water], walls: [tank]}\n"
          "run: {end: 100 s}\n";
  return text.str();
}

}  // namespace

Cost run_dam_break(double water_particles, int outer_steps, int threads) {
  std::ofstream("bench.yaml") << dam_break(std::cbrt(2.0 / water_particles));
  const std::string command = std::string("'" SHOAL_PROGRAM "' run bench.yaml --force -q -o bench_results") +
                              " --plugin-path '" SHOAL_PLUGINS_FOLDER "' --checkpoint-every 0 --steps " +
                              std::to_string(outer_steps) + " --threads " + std::to_string(threads) +
                              " > bench.log 2>&1";
  if (std::system(command.c_str()) != 0) {
    std::ifstream log("bench.log");
    throw std::runtime_error(command + "\n" + std::string(std::istreambuf_iterator<char>(log), {}));
  }
  const nlohmann::json summary = nlohmann::json::parse(std::ifstream("bench_results/summary.json"));
  const auto& cost = summary["cost"];
  Cost result;
  result.particles = summary["particles"];
  result.steps_seconds = cost["steps_seconds"];
  result.overhead_seconds = cost["overhead_seconds"];
  result.startup_seconds = cost["startup_seconds"];
  result.particle_steps_per_second = cost["particle_steps_per_second"];
  result.bytes_per_particle = cost["field_and_list_bytes_per_particle"];
  for (const auto& loop : summary["loops"])
    if (loop["name"] == "acoustic") result.acoustic_steps = loop["steps"];
  return result;
}

}  // namespace shoal::bench
