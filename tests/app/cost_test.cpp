// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A scene pays for what it uses: taking a feature out of a case takes its operators and fields out of the plan, its
// bytes out of the memory, and its lines out of the timings of a run.
#include <regex>
#include <set>

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
  static const std::regex op(R"(^ +([a-z_]+\.[a-z_.]+)  on (\w+).*$)");
  static const std::regex field(R"(^    ([a-z_]+) +(scalar|vector|symmetric|matrix|array).*$)");
  static const std::regex body(R"(^(\w+): [0-9 ]+particles.*$)");
  static const std::regex total(R"(.*\(([0-9.]+) bytes per particle\)$)");
  std::istringstream lines(result.out);
  std::string current;
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_match(line, match, op)) plan.operators.insert(match[1].str() + " on " + match[2].str());
    if (std::regex_match(line, match, body)) current = match[1];
    if (std::regex_match(line, match, field)) plan.fields.insert(current + "." + match[1].str());
    if (std::regex_match(line, match, total)) plan.bytes = std::strtod(match[1].str().c_str(), nullptr);
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
  static const std::regex name(R"re("name":"([a-z_]+\.[a-z_.]+)")re");
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
  const std::string bare = replaced(replaced(water, ", walls: [tank]", ""), "    material: fluid.wall\n", "");
  const Plan full = plan_of(water), less = plan_of(bare);
  for (const std::string& name : less.operators) CHECK_FALSE(contains(name, "walls"));
  CHECK(full.operators.size() >= less.operators.size() + 4);
  CHECK(less.bytes < full.bytes);
}

TEST_CASE("what a probe asks for is computed for the probe alone") {
  const std::string probe = "probes:\n  load: {sum: {of: force.x, body: tank}, every: 1}\n";
  check_cost(water + probe, water, {"fluid.wall_force on tank"}, {"tank.force"});
}

TEST_CASE("a plate without clamps or gravity does not pay for them") {
  const Plan full = plan_of(plate);
  const Plan free = plan_of(replaced(plate, "  - solid.clamp: {bodies: [plate], where: x < dx}\n", ""));
  CHECK(without(free.operators, full.operators) == Names{});
  CHECK_FALSE(without(full.operators, free.operators).empty());
  for (const std::string& name : without(full.operators, free.operators)) CHECK(contains(name, "clamp"));
  const Plan weightless = plan_of(replaced(plate, "gravity: [0, -9.81]\n", ""));
  CHECK(weightless.bytes <= full.bytes);
  CHECK(weightless.operators.size() <= full.operators.size());
}
