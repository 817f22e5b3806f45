// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Probes against values computed here from the lattice and the initial fields.
#include <cmath>
#include <functional>
#include <numbers>

#include "tests/app/support.hpp"

using namespace app_test;

namespace {

// The pile of support.hpp: cell centres of a 20 x 10 lattice.
struct Grain {
  double x, y;
};
std::vector<Grain> lattice() {
  std::vector<Grain> all;
  for (int j = 0; j < 10; ++j)
    for (int i = 0; i < 20; ++i) all.push_back({0.05 + 0.1 * i, 0.55 + 0.1 * j});
  return all;
}

// Wendland C2 in two dimensions, h = 0.13.
double wendland(double r) {
  const double h = 0.13, q = r / h;
  if (q >= 2.0) return 0.0;
  return 7.0 / (4.0 * std::numbers::pi * h * h) * std::pow(1.0 - 0.5 * q, 4) * (1.0 + 2.0 * q);
}

double shepard(const std::vector<Grain>& grains, double x, double y,
               const std::function<double(const Grain&)>& f) {
  double sum = 0.0, weight = 0.0;
  for (const Grain& grain : grains) {
    const double w = wendland(std::hypot(grain.x - x, grain.y - y));
    sum += w * f(grain);
    weight += w;
  }
  return sum / weight;
}

// The first row of a probe, without its time.
std::vector<double> first(const std::string& folder, const std::string& probe) {
  std::vector<double> row = rows(folder + "/probes/" + probe + ".csv").at(0);
  CHECK(row.at(0) == 0.0);
  row.erase(row.begin());
  return row;
}

Result run_once(const std::string& name, const std::string& text) {
  write(name + ".yaml", text);
  return shoal({"run", name + ".yaml", "-o", name, "--force", "--steps", "0"});
}

}  // namespace

TEST_CASE("maximum, minimum, sum and mean of expressions, with conditions") {
  const Result result = run_once("reduce", grains(R"(probes:
  right: {maximum: {of: position.x, body: pile}, every: 1 ms}
  low: {minimum: {of: "y - $dx", body: [pile]}, every: 1 ms}
  mass: {sum: {of: mass, body: pile}, every: 1 ms}
  energy: {sum: {of: 0.5 * mass * velocity.magnitude^2, body: pile, unit: J}, every: 1 ms}
  demanded: {sum: {of: kinetic_energy, body: pile}, every: 1 ms}
  left_speed: {mean: {of: [velocity.x, velocity.y], body: pile, where: "position.x < 1 && position.y > 1"}, every: 1 ms}
  momentum: {sum: {of: "mass^2*velocity.magnitude^2", body: pile, root: true}, every: 1 ms}
  none: {mean: {of: mass, body: pile, where: "x > 5"}, every: 1 ms}
  nothing: {sum: {of: mass, body: pile, where: "x > 5"}, every: 1 ms}
)"));
  INFO(result.err);
  REQUIRE(result.code == 0);
  CHECK(first("reduce", "right")[0] == doctest::Approx(1.95).epsilon(1e-14));
  CHECK(first("reduce", "low")[0] == doctest::Approx(0.45).epsilon(1e-14));
  CHECK(first("reduce", "mass")[0] == doctest::Approx(2000.0).epsilon(1e-12));
  double energy = 0.0, sum_x = 0.0, sum_y = 0.0;
  int n = 0;
  for (const Grain& grain : lattice()) {
    const double u = 0.1 + 0.2 * grain.x, v = 0.3 * grain.y;
    energy += 0.5 * 10.0 * (u * u + v * v);
    if (grain.x >= 1.0 || grain.y <= 1.0) continue;
    sum_x += u;
    sum_y += v;
    ++n;
  }
  CHECK(first("reduce", "energy")[0] == doctest::Approx(energy).epsilon(1e-12));
  CHECK(first("reduce", "momentum")[0] == doctest::Approx(std::sqrt(2.0 * 10.0 * energy)).epsilon(1e-12));
  CHECK(first("reduce", "demanded")[0] == doctest::Approx(energy).epsilon(1e-12));
  CHECK(first("reduce", "left_speed")[0] == doctest::Approx(sum_x / n).epsilon(1e-12));
  CHECK(first("reduce", "left_speed")[1] == doctest::Approx(sum_y / n).epsilon(1e-12));
  CHECK(std::isnan(first("reduce", "none")[0]));
  CHECK(first("reduce", "nothing")[0] == 0.0);
  CHECK(contains(result.err, "probe 'none': no particle meets its condition"));
  CHECK(contains(read("reduce/probes/energy.csv"), "time [s],energy [J]\n"));
  CHECK(contains(read("reduce/probes/mass.csv"), "time [s],mass [kg]\n"));
  CHECK(contains(read("reduce/probes/left_speed.csv"), "time [s],velocity.x [m/s],velocity.y [m/s]\n"));
}

TEST_CASE("point interpolates with Shepard's normalisation") {
  const Result result = run_once("point", grains(R"(probes:
  inside: {point: {of: [velocity.x, velocity.y, mass], at: [0.83, 1.01], body: pile}, every: 1 ms}
  corner: {point: {of: [velocity.x, "1", velocity.magnitude], at: [0, 0.5], body: pile}, every: 1 ms}
  outside: {point: {of: velocity.x, at: [4, 1], body: pile}, every: 1 ms}
  rim: {point: {of: velocity.x, at: [2.2, 1], body: pile}, every: 1 ms}
  moving: {point: {of: velocity.x, at: ["1 + t", 1], body: pile}, every: 1 ms}
  linear: {point: {of: [velocity.x, velocity.y], at: [0, 0.5], body: pile, linear: true}, every: 1 ms}
)"));
  INFO(result.err);
  REQUIRE(result.code == 0);
  const std::vector<Grain> pile = lattice();
  const auto u = [](const Grain& grain) { return 0.1 + 0.2 * grain.x; };
  const auto v = [](const Grain& grain) { return 0.3 * grain.y; };
  const auto speed = [&](const Grain& grain) { return std::hypot(u(grain), v(grain)); };
  CHECK(first("point", "inside")[0] == doctest::Approx(shepard(pile, 0.83, 1.01, u)).epsilon(1e-12));
  CHECK(first("point", "inside")[1] == doctest::Approx(shepard(pile, 0.83, 1.01, v)).epsilon(1e-12));
  CHECK(first("point", "inside")[2] == doctest::Approx(10.0).epsilon(1e-12));
  CHECK(first("point", "corner")[0] == doctest::Approx(shepard(pile, 0.0, 0.5, u)).epsilon(1e-12));
  CHECK(first("point", "corner")[1] == doctest::Approx(1.0).epsilon(1e-12));
  CHECK(first("point", "corner")[2] == doctest::Approx(shepard(pile, 0.0, 0.5, speed)).epsilon(1e-12));
  CHECK(std::isnan(first("point", "outside")[0]));
  // 0.2 beyond the last column there are neighbours, but too few to mean anything.
  CHECK(std::isnan(first("point", "rim")[0]));
  CHECK(contains(result.err, "probe 'outside': too few particles near its point"));
  CHECK(first("point", "moving")[0] == doctest::Approx(0.3).epsilon(1e-12));
  // u and v are linear: in the corner they are exact, where the plain mean lies inside.
  CHECK(first("point", "linear")[0] == doctest::Approx(0.1).epsilon(1e-12));
  CHECK(first("point", "linear")[1] == doctest::Approx(0.15).epsilon(1e-12));
}

TEST_CASE("a point with a diameter is the mean over a disc, in 2D over chords") {
  const Result result = run_once("disc", grains(R"(probes:
  gauge: {point: {of: velocity.y, at: [1, 1], body: pile, diameter: 0.4, normal: [2, 0]}, every: 1 ms}
  half: {point: {of: "1", at: [1, 0], body: pile, diameter: 6, normal: [1, 0], empty: 0}, every: 1 ms}
  rest: {point: {of: "1", at: [1, 0], body: pile, diameter: 6, normal: [1, 0]}, every: 1 ms}
  dry: {point: {of: velocity.x, at: [4, 1], body: pile, empty: 7}, every: 1 ms}
)"));
  INFO(result.err);
  REQUIRE(result.code == 0);
  const std::vector<Grain> pile = lattice();
  double sum = 0, weights = 0, wet = 0, all = 0;
  for (int k = 0; k < 10; ++k) {
    const double s = (k + 0.5) / 5.0 - 1.0, chord = std::sqrt(1.0 - s * s);
    sum += chord * shepard(pile, 1.0, 1.0 + 0.2 * s, [](const Grain& grain) { return 0.3 * grain.y; });
    weights += chord;
    all += chord;
    if (k == 6 || k == 7) wet += chord;  // y = 0.9 and 1.5 in a pile from 0.5 to 1.5
  }
  CHECK(first("disc", "gauge")[0] == doctest::Approx(sum / weights).epsilon(1e-12));
  CHECK(first("disc", "half")[0] == doctest::Approx(wet / all).epsilon(1e-12));
  CHECK(first("disc", "rest")[0] == doctest::Approx(1.0).epsilon(1e-12));
  CHECK(first("disc", "dry")[0] == 7.0);
  write("case.yaml", grains("probes:\n  gauge: {point: {of: velocity.y, at: [1, 1], body: pile, diameter: "
                            "0.4}, every: 1 ms}\n"));
  const Result wrong = shoal({"run", "case.yaml", "-o", "wrong", "--force"});
  CHECK(wrong.code == 2);
  CHECK(contains(wrong.err, "the disc of probe 'gauge' needs its axis, e.g. normal: [1, 0]"));
}

TEST_CASE("point sees through periodic and mirror faces") {
  std::string text = grains(R"(domain: {lower: [0, 0.5], upper: [2, 1.5], periodic: [x], mirror: [lower_y]}
probes:
  edge: {point: {of: [velocity.x, position.x], at: [0.02, 1], body: pile}, every: 1 ms}
  wall: {point: {of: [velocity.y, velocity.x, position.y], at: [1, 0.5], body: pile}, every: 1 ms}
)",
                            "bodies: [pile], floor: -10");
  text.replace(text.find("0.3*y"), 5, "0.7");
  const Result result = run_once("images", text);
  INFO(result.err);
  REQUIRE(result.code == 0);
  std::vector<Grain> periodic = lattice();
  const auto u = [](const Grain& grain) {
    return 0.1 + 0.2 * (grain.x < 0.0 ? grain.x + 2.0 : grain.x > 2.0 ? grain.x - 2.0 : grain.x);
  };
  for (const Grain& grain : lattice()) {
    periodic.push_back({grain.x - 2.0, grain.y});
    periodic.push_back({grain.x + 2.0, grain.y});
  }
  CHECK(first("images", "edge")[0] == doctest::Approx(shepard(periodic, 0.02, 1.0, u)).epsilon(1e-12));
  const auto x = [](const Grain& grain) { return grain.x; };
  CHECK(first("images", "edge")[1] == doctest::Approx(shepard(periodic, 0.02, 1.0, x)).epsilon(1e-9));
  CHECK(std::abs(first("images", "wall")[0]) < 1e-14);
  CHECK(first("images", "wall")[1] == doctest::Approx(0.3).epsilon(1e-12));
  CHECK(first("images", "wall")[2] == doctest::Approx(0.5).epsilon(1e-12));
}

TEST_CASE("a table has the first step at or after each due time") {
  write("due.yaml", grains("probes:\n  p: {maximum: {of: \"t\", body: pile}, every: 7 ms}\n"
                           "output:\n  - grains.tables: {every: 1 s, at: [30 ms, 60 ms]}\n"));
  REQUIRE(shoal({"run", "due.yaml", "-o", "due", "--force"}).code == 0);
  const auto table = rows("due/probes/p.csv");
  REQUIRE(table.size() == 15);
  for (std::size_t k = 0; k < table.size(); ++k) {
    const double due = 0.007 * static_cast<double>(k);
    CHECK(table[k][0] >= due - 1e-12);
    CHECK(table[k][0] < due + 1e-3);
    CHECK(table[k][1] == table[k][0]);
  }
  CHECK(std::filesystem::exists("due/grains.tables/2.txt"));
  CHECK_FALSE(std::filesystem::exists("due/grains.tables/3.txt"));
}

TEST_CASE("probes of plugins: named columns, fields on demand, failures") {
  const Result result = run_once("plugin_probe", grains(R"(probes:
  centre: {grains.centre: {body: pile}, every: 1 ms}
  energy: {grains.centre: {body: pile, field: kinetic_energy}, every: 1 ms}
)"));
  INFO(result.err);
  REQUIRE(result.code == 0);
  CHECK(contains(read("plugin_probe/probes/centre.csv"), "time [s],x [m],y [m],weight [kg]\n"));
  CHECK(first("plugin_probe", "centre")[0] == doctest::Approx(1.0).epsilon(1e-12));
  CHECK(first("plugin_probe", "centre")[1] == doctest::Approx(1.0).epsilon(1e-12));
  CHECK(first("plugin_probe", "centre")[2] == doctest::Approx(2000.0).epsilon(1e-12));
  CHECK(first("plugin_probe", "energy")[2] > 0.0);
  const Result part =
      run_once("plugin_probe", grains("probes:\n  p: {grains.centre: {body: pile, field: velocity.y}, "
                                      "every: 1 ms}\n"));
  CHECK(part.code == 0);
  const Result unknown =
      run_once("plugin_probe", grains("probes:\n  p: {grains.centre: {body: pile, field: charge}, "
                                      "every: 1 ms}\n"));
  CHECK(unknown.code == 2);
  CHECK(contains(unknown.err, "has no field 'charge'"));
  const Result fails =
      run_once("plugin_probe", grains("probes:\n  p: {grains.centre: {body: pile, field: acceleration.x}"
                                      ", every: 1 ms}\n"));
  CHECK(fails.code == 3);
  CHECK(contains(fails.err, "grains.centre: nothing has a weight"));
}
