// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Materials of a plugin that the solid plugin has never heard of, in its solver.
#include <cmath>

#include "tests/app/support.hpp"

using namespace app_test;

namespace {

constexpr double mu = 4e5, K = 1.2e6, E = 9.0 * K * mu / (3.0 * K + mu),
                 nu = (3.0 * K - 2.0 * mu) / (6.0 * K + 2.0 * mu);

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}
const std::string neo_hookean = "solid.neo_hookean: {density: 1000, youngs_modulus: " + number(E) +
                                ", poisson_ratio: " + number(nu) + "}";

std::string block(const std::string& material, const std::string& velocity) {
  return "shoal: 1\n"
         "plugins: [solid, rubber]\n"
         "dimensions: 3\n"
         "parameters: {dx: 1/6}\n"
         "resolution: $dx\n"
         "bodies:\n"
         "  block:\n"
         "    shape: {box: {lower: [0, 0, 0], upper: [1, 1, 1]}}\n"
         "    material: {" +
         material + "}\n    initial: {velocity: " + velocity +
         "}\n"
         "physics:\n"
         "  - solid.total_lagrangian: {bodies: [block], damping: 30}\n"
         "run: {end: 0.6 s}\n"
         "probes:\n"
         "  stretch: {mean: {of: [deformation_gradient.xx, deformation_gradient.yy], body: block}, every: 20 "
         "ms}\n";
}

std::vector<double> last_stretch(const std::string& name, const std::string& material,
                                 const std::string& velocity) {
  write(name + ".yaml", block(material, velocity));
  const Result result = app_test::shoal({"run", name + ".yaml", "-o", name, "--force", "--threads", "1"});
  REQUIRE_MESSAGE(result.code == 0, result.err);
  return rows(name + "/probes/stretch.csv").back();
}

}  // namespace

TEST_CASE("a law that wraps one of another plugin contracts a free block to its equilibrium") {
  // Of the split neo-Hookean law at stretches l along x and a across: sides free, and P_xx = -T l.
  const double T = 1e5;
  double l = 1.0, a = 1.0;
  const auto P = [](double along, double across, double stretch) {
    const double J = along * across * across, I1 = along * along + 2.0 * across * across;
    return mu * std::pow(J, -2.0 / 3.0) * (stretch - I1 / (3.0 * stretch)) +
           K / 2.0 * (J * J - 1.0) / stretch;
  };
  for (int k = 0; k < 4000; ++k) {
    a -= 1e-7 * P(l, a, a);
    l -= 1e-7 * (P(l, a, l) + T * l);
  }
  const auto last = last_stretch(
      "active", "rubber.active: {tension: " + number(T) + ", passive: {" + neo_hookean + "}}", "[0, 0, 0]");
  CHECK(l < 0.95);
  CHECK(last[1] == doctest::Approx(l).epsilon(5e-3));
  CHECK(last[2] == doctest::Approx(a).epsilon(5e-3));
}

TEST_CASE("a third party's law moves a body as the solid plugin's does where the two are one") {
  const std::string stretching = "[\"4*(x - 0.5)\", 0, 0]";
  const std::string gent = "rubber.gent: {density: 1000, shear_modulus: 4e5, bulk_modulus: 1.2e6, taut: 1e9}";
  write("a.yaml", block(gent, stretching));
  write("b.yaml", block(neo_hookean, stretching));
  for (const char* name : {"a", "b"}) {
    const Result result = app_test::shoal({
        "run",
        std::string(name) + ".yaml",
        "-o",
        name,
        "--force",
        "--threads",
        "1",
    });
    REQUIRE_MESSAGE(result.code == 0, result.err);
  }
  const auto own = rows("a/probes/stretch.csv"), theirs = rows("b/probes/stretch.csv");
  REQUIRE(own.size() > 20);
  double largest = 0.0;
  for (std::size_t k = 0; k < std::min(own.size(), theirs.size()); ++k) {
    CHECK(own[k][1] == doctest::Approx(theirs[k][1]).epsilon(1e-6));
    largest = std::max(largest, std::abs(own[k][1] - 1.0));
  }
  CHECK(largest > 0.03);  // it did move
}

TEST_CASE("a material without a stress law cannot be wrapped") {
  write("wrong.yaml",
        block("rubber.active: {tension: 1, passive: {rubber.active: {tension: 1, passive: fluid.wall}}}",
              "[0, 0, 0]"));
  std::string text = read("wrong.yaml");
  text.replace(text.find("[solid, rubber]"), 15, "[solid, rubber, fluid]");
  write("wrong.yaml", text);
  const Result result = app_test::shoal({"plan", "wrong.yaml"});
  CHECK(result.code == 2);
  CHECK_MESSAGE(contains(result.err, "this material has no stress law"), result.err);
}
