// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The program with the fluid plugin, on a dam break that is large enough for threads to be used: the same bits on one
// thread, on two and after a restart; and a plan in which only what the case asks for stands.
#include <set>

#include "kernel/particles/parallel.hpp"
#include "tests/app/support.hpp"

using namespace app_test;

namespace {

const std::string probes =
    "probes:\n"
    "  front: {maximum: {of: position.x, body: water}, every: 1 ms}\n"
    "  energy: {sum: {of: 0.5*mass*velocity.magnitude^2, body: water}, every: 1 ms}\n";

std::string dam(const std::string& more) {
  return "shoal: 1\n"
         "plugins: [fluid]\n"
         "dimensions: 2\n"
         "parameters: {dx: 1/60, viscosity: 0}\n"
         "resolution: $dx\n"
         "gravity: [0, -9.81]\n"
         "bodies:\n"
         "  water:\n"
         "    shape: {box: {lower: [0, 0], upper: [2, 1]}}\n"
         "    material: {fluid.liquid: {density: 1000, viscosity: $viscosity}}\n"
         "  tank:\n"
         "    shape: {shell: {of: {box: {lower: [0, 0], upper: [3, 1.5]}}, thickness: 4*dx}}\n"
         "    material: fluid.wall\n"
         "physics:\n"
         "  - fluid.wcsph: {bodies: [water], walls: [tank]}\n"
         "run: {end: 60 ms}\n" +
         more;
}

constexpr std::uint64_t water_particles = 120 * 60;
static_assert(water_particles > shoal::kernel::serial_below, "else no thread but one is ever used");

void check_same(const std::string& a, const std::string& b) {
  CAPTURE(a);
  CAPTURE(b);
  for (const char* probe : {"front", "energy"}) {
    const std::string table = read(a + "/probes/" + probe + ".csv");
    CHECK(rows(a + "/probes/" + probe + ".csv").size() > 20);
    CHECK(table == read(b + "/probes/" + probe + ".csv"));
  }
  const std::string fields = final_fields(a);
  CHECK(fields.size() > water_particles * 80);
  const bool same = fields == final_fields(b);  // else doctest would print all of them
  CHECK(same);
}

std::string plan(const std::vector<std::string>& settings) {
  std::vector<std::string> arguments{"plan", "dam.yaml"};
  for (const std::string& setting : settings) {
    arguments.emplace_back("--set");
    arguments.push_back(setting);
  }
  const Result result = app_test::shoal(arguments);
  INFO(result.err);
  REQUIRE(result.code == 0);
  return result.out;
}

}  // namespace

TEST_CASE("the same bits on one thread and two, and after two restarts") {
  write("dam.yaml", dam(probes));
  REQUIRE(app_test::shoal({"run", "dam.yaml", "-o", "one", "--force", "--threads", "1"}).code == 0);
  REQUIRE(app_test::shoal({"run", "dam.yaml", "-o", "two", "--force", "--threads", "2"}).code == 0);
  REQUIRE(contains(read("one/summary.json"), "\"threads\": 1"));
  REQUIRE(contains(read("two/summary.json"), "\"threads\": 2"));
  check_same("one", "two");

  REQUIRE(app_test::shoal({"run", "dam.yaml", "-o", "parts", "--force", "--threads", "2", "--until", "0.021"})
              .code == 0);
  REQUIRE(app_test::shoal({"resume", "parts", "--threads", "1", "--steps", "7"}).code == 0);
  REQUIRE(app_test::shoal({"resume", "parts", "--threads", "2"}).code == 0);
  check_same("one", "parts");
}

TEST_CASE("viscosity is in the plan of a viscous case only") {
  write("dam.yaml", dam(""));
  const std::string inviscid = plan({}), viscous = plan({"viscosity=1"});
  CHECK_FALSE(contains(inviscid, "viscous"));
  CHECK(contains(viscous, "fluid.viscous_force  on water with water"));
  CHECK(contains(viscous, "fluid.viscous_force.walls  on water with tank"));
  CHECK(contains(viscous, "signed_distance"));
}

TEST_CASE("without walls no operator, relation or field of walls is left") {
  write("dam.yaml", dam(""));
  const std::string with = plan({}), without = plan({"physics.fluid.wcsph.walls=[]"});
  for (const char* part : {"fluid.density.walls", "fluid.pressure_force.walls", "fluid.divergence.walls",
                           "water - tank", "wall_density_sum", "normal"}) {
    CHECK_MESSAGE(contains(with, part), part);
    CHECK_FALSE_MESSAGE(contains(without, part), part);
  }
  CHECK(contains(without, "fluid.density  on water with water"));
}

TEST_CASE("a shift of particles is in the plan only where there is no free surface") {
  write("dam.yaml", dam(""));
  CHECK_FALSE(contains(plan({}), "transport_shift"));
  const std::string closed = plan({"physics.fluid.wcsph.free_surface=false"});
  CHECK(contains(closed, "fluid.transport_shift  on water with water"));
  CHECK(contains(closed, "fluid.apply_shift"));
}

TEST_CASE("a case that lists only fluid opens only the fluid's library") {
  write("long.yaml", dam(""));
  std::filesystem::remove_all("mapped");
  Process process(
      {"run", "long.yaml", "-o", "mapped", "--set", "run.end=1000", "--plugin-path", SHOAL_PLUGINS_FOLDER});
  REQUIRE(eventually([] {
    return std::filesystem::exists("mapped/summary.json") || std::filesystem::exists("mapped/case.yaml");
  }));
  std::set<std::string> plugins;
  std::istringstream lines(read("/proc/" + std::to_string(process.pid()) + "/maps"));
  for (std::string line; std::getline(lines, line);)
    for (const char* folder : {SHOAL_TEST_PLUGINS "/", SHOAL_PLUGINS_FOLDER "/"})
      if (contains(line, folder)) plugins.insert(line.substr(line.rfind('/') + 1));
  CHECK(plugins == std::set<std::string>{"fluid.so"});
}
