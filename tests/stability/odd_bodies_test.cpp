// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Bodies that nobody means to make but everybody makes once: one particle thick, without any particle, with particles
// in one place, of one particle.
#include "tests/stability/scenes.hpp"

using namespace stability;

namespace {

// Neither NaN nor growth: the sum of the energies never exceeds `factor` times that of the start.
void check_energy(const std::string& output, double factor) {
  const auto table = rows(output + "/probes/energy.csv");
  REQUIRE(table.size() > 5);
  const auto total = [](const std::vector<double>& row) {
    double sum = 0;
    for (std::size_t c = 1; c < row.size(); ++c) sum += row[c];
    return sum;
  };
  for (const auto& row : table) CHECK(total(row) <= factor * total(table.front()));
}

}  // namespace

TEST_CASE("a film of water one particle deep falls and spreads") {
  // Dissipation only: the energy of the start is the upper bound, but for what compression stores (Mach 0.1: 1 %).
  const std::string film = replaced(dam_break, "upper: [S, 0.6*S]", "upper: [S, dx]");
  const Result result = run(film, "film");
  CHECK_MESSAGE(result.code == 0, result.err);
  check_energy("film", 1.01);
}

TEST_CASE("a drop of one particle falls freely and stays in its tank") {
  const std::string drop = replaced(dam_break, "lower: [0, 0], upper: [S, 0.6*S]",
                                    "lower: [S, 0.6*S], upper: [S + dx, 0.6*S + dx]");
  const Result result = run(drop, "drop", {"--set", "run.end=0.3"});
  REQUIRE_MESSAGE(result.code == 0, result.err);
  const auto lengths = rows("drop/probes/lengths.csv");
  for (const auto& row : lengths) {  // y0 - g t^2 / 2, integrated exactly
    CHECK(row[1] == doctest::Approx(lengths.front()[1]).epsilon(1e-12));
    CHECK(row[2] == doctest::Approx(lengths.front()[2] - 5.0 * row[0] * row[0]).epsilon(1e-9));
  }
}

TEST_CASE("a plate one particle thick is refused, one of two bends") {
  const Result thin = run(replaced(plate, "upper: [S, 0.12*S]", "upper: [S, dx]"), "foil");
  CHECK(thin.code == 2);
  CHECK(contains(thin.err, "at least two particles thick"));
  const Result two = run(replaced(plate, "upper: [S, 0.12*S]", "upper: [S, 2*dx]"), "foil",
                         {"--set", "bodies.plate.initial.velocity=[0, S*(x/S)^2]"});
  CHECK_MESSAGE(two.code == 0, two.err);
  check_energy("foil", 1.01);
}

TEST_CASE("a rod one particle thick conducts heat") {
  const std::string rod = replaced(heat, "upper: [S, S]", "upper: [S, dx]");
  const Result result = run(rod, "rod");
  if (result.code == 0) {
    check_energy("rod", 1.0 + 1e-9);
  } else {
    CHECK(result.code == 2);
    CHECK(contains(result.err, "plate"));
  }
}

TEST_CASE("a body without particles is refused with its name, or does nothing") {
  for (const std::string* scene : {&dam_break, &plate, &heat}) {
    const auto at = scene->find("upper: [S,");
    REQUIRE(at != std::string::npos);
    std::string text = *scene;
    text.replace(at, text.find(']', at) - at + 1, "upper: [dx/100, dx/100]");
    const Result result = run(text, "empty");
    INFO(result.err);
    CHECK(result.code == 2);
    CHECK(contains(result.err, "no particle"));
  }
}

TEST_CASE("particles in one place push nobody to infinity") {
  // A second body of water on top of a part of the first, particle upon particle. Twice the mass in one place is
  // nothing that the equations describe: the run either goes on with finite numbers or stops with the place.
  const std::string twice = replaced(dam_break, "  tank:\n",
                                     "  more:\n"
                                     "    shape: {box: {lower: [0, 0], upper: [4*dx, 4*dx]}}\n"
                                     "    material: {fluid.liquid: {density: 1000}}\n"
                                     "  tank:\n");
  const Result result = run(replaced(twice, "bodies: [water]", "bodies: [water, more]"), "twice");
  INFO(result.err);
  if (result.code == 0) {
    for (const auto& row : rows("twice/probes/energy.csv"))
      for (const double value : row) CHECK(std::isfinite(value));
  } else {
    CHECK((result.code == 2 || result.code == 3));
    CHECK((contains(result.err, "water") || contains(result.err, "more")));
    CHECK_FALSE(contains(result.err, "nan"));
  }
}
