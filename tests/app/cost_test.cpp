// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A scene pays for what it uses: taking a feature out of a case takes its operators and fields out of the plan, its
// bytes out of the memory, and its lines out of the timings of a run.
#include <regex>
#include <set>
#include <utility>

#include "tests/app/support.hpp"

using namespace app_test;

namespace {

using Names = std::set<std::string>;

struct Plan {
  Names operators, fields;
  double bytes;
};

Plan plan_of(const std::string& scene) {
  write("scene.yaml", scene);
  const Result result = shoal({"plan", "scene.yaml"});
  REQUIRE_MESSAGE(result.code == 0, result.err);
  Plan plan{};
  static const std::regex op(R"(^ +([a-z_]+\.[a-z_.0-9]+)  on (\w+).*$)");
  static const std::regex field(R"(^    ([a-z_]+) +(scalar|vector|symmetric|matrix|array).*$)");
  static const std::regex body(R"(^(\w+): [0-9 ]+particles.*$)");
  static const std::regex total(R"(([0-9]+) particles; .*\(([0-9.]+) bytes per particle\)$)");
  std::istringstream lines(result.out);
  std::string current;
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_match(line, match, op)) plan.operators.insert(match[1].str() + " on " + match[2].str());
    if (std::regex_match(line, match, body)) current = match[1];
    if (std::regex_match(line, match, field)) plan.fields.insert(current + "." + match[1].str());
    if (std::regex_match(line, match, total))
      plan.bytes =
          std::strtod(match[1].str().c_str(), nullptr) * std::strtod(match[2].str().c_str(), nullptr);
  }
  REQUIRE(plan.operators.size() > 1);
  REQUIRE(plan.fields.size() > 2);
  REQUIRE(plan.bytes > 0);
  return plan;
}

// Operators that a run of a few steps spent time in.
Names timed(const std::string& scene) {
  write("scene.yaml", scene);
  const Result result = shoal({"run", "scene.yaml", "-o", "scene", "--force", "--steps", "2", "--json"});
  REQUIRE_MESSAGE(result.code == 0, result.err);
  Names names;
  static const std::regex name(R"re("name":"([a-z_]+\.[a-z_.0-9]+)")re");
  for (std::sregex_iterator k(result.out.begin(), result.out.end(), name), end; k != end; ++k)
    names.insert((*k)[1]);
  REQUIRE(names.size() > 1);
  return names;
}

Names without(const Names& all, const Names& some) {
  Names rest;
  std::set_difference(all.begin(), all.end(), some.begin(), some.end(), std::inserter(rest, rest.end()));
  return rest;
}

std::string text(const Names& names) {
  std::string all;
  for (const std::string& name : names) all += name + "; ";
  return all;
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const auto at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), with);
}

// With the feature there is all that there is without it, and `operators` and `fields` more, exactly.
void check_cost(const std::string& with, const std::string& bare, const Names& operators,
                const Names& fields) {
  const Plan full = plan_of(with), less = plan_of(bare);
  CHECK(text(without(less.operators, full.operators)) == "");
  CHECK(text(without(less.fields, full.fields)) == "");
  CHECK(text(without(full.operators, less.operators)) == text(operators));
  CHECK(text(without(full.fields, less.fields)) == text(fields));
  if (!fields.empty()) CHECK(full.bytes > less.bytes);
  const Names rest = without(timed(with), timed(bare));
  for (const std::string& name : operators) CHECK(rest.count(name.substr(0, name.find(' '))) == 1);
  CHECK(rest.size() <= operators.size());
}

const std::string water =
    "shoal: 1\n"
    "plugins: [fluid]\n"
    "dimensions: 2\n"
    "parameters: {dx: 50 mm}\n"
    "resolution: $dx\n"
    "gravity: [0, -9.81]\n"
    "bodies:\n"
    "  water:\n"
    "    shape: {box: {lower: [0, 0], upper: [1, 0.5]}}\n"
    "    material: {fluid.liquid: {density: 1000, viscosity: 1}}\n"
    "  tank:\n"
    "    shape: {shell: {of: {box: {lower: [0, 0], upper: [1, 0.6]}}, thickness: 4*dx}}\n"
    "    material: fluid.wall\n"
    "physics:\n"
    "  - fluid.wcsph: {bodies: [water], walls: [tank], max_speed: 5}\n"
    "run: {end: 1}\n";

const std::string plate =
    "shoal: 1\n"
    "plugins: [solid]\n"
    "dimensions: 2\n"
    "parameters: {dx: 20 mm}\n"
    "resolution: $dx\n"
    "gravity: [0, -9.81]\n"
    "bodies:\n"
    "  plate:\n"
    "    shape: {box: {lower: [0, 0], upper: [1, 0.2]}}\n"
    "    material: {solid.neo_hookean: {density: 1000, youngs_modulus: 1e6, poisson_ratio: 0.3}}\n"
    "physics:\n"
    "  - solid.total_lagrangian: {bodies: [plate]}\n"
    "  - solid.clamp: {bodies: [plate], where: x < dx}\n"
    "run: {end: 1}\n";

const std::string heat =
    "shoal: 1\n"
    "plugins: [diffusion]\n"
    "dimensions: 2\n"
    "parameters: {dx: 50 mm}\n"
    "resolution: $dx\n"
    "bodies:\n"
    "  plate:\n"
    "    shape: {box: {lower: [0, 0], upper: [1, 1]}}\n"
    "    material: {diffusion.medium: {diffusivity: 0.01}}\n"
    "    initial: {concentration: x*y}\n"
    "physics:\n"
    "  - diffusion.diffusion: {bodies: [plate], fields: [concentration], integrator: rk2}\n"
    "run: {end: 1}\n";

}  // namespace

TEST_CASE("water without viscosity, gravity or the velocity filter does not pay for them") {
  check_cost(water, replaced(water, ", viscosity: 1", ""),
             {"fluid.viscous_force on water", "fluid.viscous_force.walls on water"}, {});
  check_cost(water, replaced(water, "gravity: [0, -9.81]\n", ""), {"fluid.gravity on water"}, {});
  check_cost(water, replaced(water, "max_speed: 5", "max_speed: 5, velocity_filter: 0"),
             {"fluid.velocity_fluctuation on water", "fluid.velocity_filter on water"},
             {"water.velocity_fluctuation"});
}

TEST_CASE("nor does water without walls") {
  const std::string bare =
      replaced(replaced(water, ", walls: [tank]", ""),
               water.substr(water.find("  tank:"), water.find("physics:") - water.find("  tank:")), "");
  check_cost(water, bare,
             {"fluid.density.walls on water", "fluid.divergence.walls on water",
              "fluid.pressure_force.walls on water", "fluid.viscous_force.walls on water"},
             {"tank.normal", "tank.position", "tank.signed_distance", "tank.velocity", "tank.volume",
              "water.wall_density_sum"});
}

TEST_CASE("what a scheme for water can do more is paid for where it is asked") {
  const auto asked = [](const std::string& key) {
    return replaced(water, "max_speed: 5", "max_speed: 5, " + key);
  };
  // Corrected gradients are in double precision, and so go without the records and the frozen geometry that others have.
  check_cost(asked("precision: double, gradient_correction: true"), asked("precision: double"),
             {"fluid.gradient_matrix on water", "fluid.gradient_moment on water",
              "fluid.gradient_moment.walls on water"},
             {"water.gradient_matrix", "water.pressure_matrix"});
  check_cost(asked("shift_strength: 0.5"), water,
             {"fluid.along_surface on water", "fluid.apply_shift on water", "fluid.crowding on water",
              "fluid.crowding.walls on water"},
             {"water.filled", "water.transport_shift"});
}

TEST_CASE("what an output asks for is computed for the output alone, and what there is costs nothing") {
  const auto written = [](const std::string& field) {
    return replaced(water, "plugins: [fluid]", "plugins: [fluid, vtk]") +
           "output: [vtk: {every: 1, fields: [" + field + "]}]\n";
  };
  check_cost(written("vorticity"), water, {"fluid.kinematics on water"},
             {"water.q_criterion", "water.vorticity"});
  check_cost(written("velocity"), water, {}, {});
}

TEST_CASE("what a probe asks for is computed for the probe alone") {
  const std::string probe = "probes:\n  load: {sum: {of: force.x, body: tank}, every: 1}\n";
  check_cost(water + probe, water, {"fluid.wall_force on tank"}, {"tank.force"});
}

TEST_CASE("damping, viscosity and averaged volumes of a plate are paid for where they are asked") {
  const auto asked = [](const std::string& key) {
    return replaced(plate, "bodies: [plate]}", "bodies: [plate], " + key + "}");
  };
  check_cost(asked("damping: 1"), plate, {"solid.mass_damping on plate"}, {});
  check_cost(asked("artificial_viscosity: 0.02"), plate, {"solid.pair_damping on plate"}, {});
  check_cost(asked("viscosity: 1"), plate,
             {"solid.kelvin_voigt on plate", "solid.kelvin_voigt.initial on plate"},
             {"plate.previous_deformation_gradient"});
  check_cost(asked("average_volume: always"), plate,
             {"solid.corrected_stress on plate", "solid.pressure_correction on plate",
              "solid.volume_ratio on plate"},
             {"plate.pressure_correction", "plate.volume_ratio"});
}

TEST_CASE("a plate without hourglass control does not pay for it, nor does a measure of its energy") {
  const std::string without = replaced(plate, "bodies: [plate]}", "bodies: [plate], hourglass: 0}");
  check_cost(plate, without, {}, {"plate.hourglass_stress"});
  const std::string probe =
      "probes:\n  energy: {sum: {of: volume*hourglass_energy, body: plate}, every: 1}\n";
  check_cost(without + probe, without, {"solid.hourglass_energy on plate"}, {"plate.hourglass_energy"});
}

TEST_CASE("so are the limiter, sources and surfaces of diffusion") {
  const auto asked = [](const std::string& key) {
    return replaced(heat, "bodies: [plate]", "bodies: [plate], " + key);
  };
  check_cost(asked("scheme: monotone"), heat, {"diffusion.limiter on plate"},
             {"plate.concentration_fall", "plate.concentration_rise"});
  check_cost(asked("source: 1"), heat, {"diffusion.source on plate"}, {});
  check_cost(
      heat, asked("scheme: conservative"), {"diffusion.surface on plate"},
      {"plate.concentration_surface", "plate.normal", "plate.signed_distance", "plate.surface_normal"});
}

TEST_CASE("a plate without clamps or gravity does not pay for them") {
  check_cost(plate, replaced(plate, "  - solid.clamp: {bodies: [plate], where: x < dx}\n", ""),
             {"solid.clamp on plate"}, {});
  check_cost(plate, replaced(plate, "gravity: [0, -9.81]\n", ""), {"solid.gravity on plate"}, {});
}
