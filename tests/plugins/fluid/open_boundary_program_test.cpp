// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The program with inlets and outlets: the same bits on one thread, on two and after a restart, the balance of mass, and
// what is refused.
#include <cmath>

#include "tests/app/support.hpp"

using namespace app_test;

namespace {

std::string channel(const std::string& inflow = "velocity: [U, 0]",
                    const std::string& outflow = "condition: pressure") {
  return "shoal: 1\n"
         "plugins: [fluid]\n"
         "dimensions: 2\n"
         "parameters: {dx: 1/60, U: 1, Lz: 6*dx}\n"
         "resolution: $dx\n"
         "bodies:\n"
         "  water:\n"
         "    shape: {box: {lower: [-Lz, 0], upper: [1.5 + Lz, 1]}}\n"
         "    material: {fluid.liquid: {density: 1000, viscosity: 10}}\n"
         "    initial: {velocity: [U, 0]}\n"
         "  plates:\n"
         "    shape: {union: {of: [{box: {lower: [-8*dx, -4*dx], upper: [1.5 + 8*dx, 0]}},\n"
         "                         {box: {lower: [-8*dx, 1], upper: [1.5 + 8*dx, 1 + 4*dx]}}]}}\n"
         "    material: {fluid.wall: {slip: free_slip}}\n"
         "physics:\n"
         "  - fluid.inflow: {bodies: [water], at: [0, 0], normal: [1, 0], " +
         inflow +
         "}\n"
         "  - fluid.wcsph: {bodies: [water], walls: [plates], max_speed: 1.5, free_surface: false}\n"
         "  - fluid.outflow: {bodies: [water], at: [1.5, 0], normal: [-1, 0], " +
         outflow +
         "}\n"
         "run: {end: 0.15}\n"
         "probes:\n"
         "  entered: {sum: {of: entered_mass, body: water}, every: 10 ms}\n"
         "  left: {sum: {of: left_mass, body: water}, every: 10 ms}\n"
         "  inside: {sum: {of: mass, body: water, where: open_boundary == 0}, every: 10 ms}\n"
         "  particles: {sum: {of: 1 + 0*mass, body: water}, every: 10 ms}\n";
}

double last(const std::string& folder, const char* probe) {
  const auto table = rows(folder + "/probes/" + probe + ".csv");
  return table.back().at(1);
}

void refused(const std::string& text, const std::string& message) {
  write("bad.yaml", text);
  const Result result = app_test::shoal({"check", "bad.yaml"});
  CHECK(result.code == 2);
  CAPTURE(result.err);
  CHECK(contains(result.err, message));
}

}  // namespace

TEST_CASE("inlet and outlet: the same bits on any number of threads and after restarts; no mass is lost") {
  write("channel.yaml",
        channel("velocity: [\"U*(1 + 0.2*sin(9*t))\", 0]", "condition: non_reflecting, averaging_time: 0.1"));
  REQUIRE(app_test::shoal({"run", "channel.yaml", "-o", "one", "--force", "--threads", "1"}).code == 0);
  REQUIRE(app_test::shoal({"run", "channel.yaml", "-o", "two", "--force", "--threads", "2"}).code == 0);
  REQUIRE(
      app_test::shoal({"run", "channel.yaml", "-o", "parts", "--force", "--threads", "2", "--until", "0.067"})
          .code == 0);
  REQUIRE(app_test::shoal({"resume", "parts", "--threads", "1"}).code == 0);
  for (const char* other : {"two", "parts"}) {
    CAPTURE(other);
    const bool same = final_fields("one") == final_fields(other);
    CHECK(same);
    for (const char* probe : {"entered", "left", "inside", "particles"})
      CHECK(read(std::string("one/probes/") + probe + ".csv") ==
            read(std::string(other) + "/probes/" + probe + ".csv"));
  }
  // What is in the fluid is what was there, what has entered and not left, to rounding.
  const double before = 1000.0 * 1.5, entered = last("one", "entered");
  CHECK(last("one", "inside") == doctest::Approx(before + entered - last("one", "left")).epsilon(1e-9));
  // The inlet's flux over time, to one column of particles
  const double given = 1000.0 * (0.15 + 0.2 / 9.0 * (1.0 - std::cos(9.0 * 0.15)));
  CHECK(std::abs(entered - given) < 1000.0 / 60.0);
  // As many particles as at first, to a column at either end
  CHECK(std::abs(last("one", "particles") - 60.0 * 102.0) < 121.0);
}

TEST_CASE("inlets and outlets that make no sense") {
  refused(channel("velocity: [U, 0], length: 2*dx"),
          "bad.yaml:16:91: the zone must be at least as long as the cut-off, 0.043333 m");
  refused(channel("velocity: [U, 0], lower: [0, 1], upper: [1, 0]"),
          "upper must be beyond lower along each axis");
  refused(channel("velocity: [U, 0]", "condition: pressure, averaging_time: 1"),
          "fluid.outflow takes averaging_time with condition: non_reflecting, and only then");
  refused(channel("velocity: [U, 0]", "condition: non_reflecting"),
          "fluid.outflow takes averaging_time with condition: non_reflecting, and only then");
  std::string flat = channel();
  flat.replace(flat.find("normal: [1, 0]"), 14, "normal: [0, 0]");
  refused(flat, "bad.yaml:16:57: the normal has no length");
}
