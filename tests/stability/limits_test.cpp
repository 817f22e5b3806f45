// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The step of each scheme is made longer until the scheme fails, as `shoal study --limits` does it. The default must hold
// on all scenes, with an energy that never exceeds that of the start by 2 %; where the limit is known it must be found.
#include <cstdio>

#include "tests/stability/scenes.hpp"

using namespace stability;

namespace {

struct Limit {
  std::string parameter, holds_to, fails_at, why;
  double standard;
};

std::vector<Limit> read_limits(const std::filesystem::path& path) {
  std::vector<Limit> limits;
  std::istringstream lines(read(path));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    Limit limit{};
    std::string standard;
    for (std::string* cell : {&limit.parameter, &standard, &limit.holds_to, &limit.fails_at})
      std::getline(cells, *cell, ',');
    std::getline(cells, limit.why);
    limit.standard = std::strtod(standard.c_str(), nullptr);
    limits.push_back(limit);
  }
  return limits;
}

// Whether the sum of the energies never exceeds that of the start by more than 2 %.
void check_energy(const std::string& results) {
  const auto table = rows(results + "/probes/energy.csv");
  REQUIRE(table.size() >= 5);
  const auto total = [](const std::vector<double>& row) {
    double sum = 0;
    for (std::size_t c = 1; c < row.size(); ++c) sum += row[c];
    return sum;
  };
  for (const auto& row : table) CHECK(total(row) <= 1.02 * total(table.front()));
}

// Of all factors that the scene's physics declares.
std::vector<Limit> limits_of(const char* name, const std::string& scene) {
  CAPTURE(name);
  write("limit.yaml", scene);
  const Result result =
      shoal({"study", "limit.yaml", "--limits", "-o", "limit", "--force", "--threads", "1"});
  REQUIRE_MESSAGE(result.code == 0, result.err);
  check_energy("limit/runs/run");
  const std::vector<Limit> limits = read_limits("limit/limits.csv");
  REQUIRE_FALSE(limits.empty());
  for (const Limit& limit : limits) {
    const std::string parameter = limit.parameter.substr(limit.parameter.rfind('.') + 1);
    std::printf("%-44s %-14s default %5.3g  holds to %5s  fails at %5s  %s\n", name, parameter.c_str(),
                limit.standard, limit.holds_to.c_str(), limit.fails_at.c_str(), limit.why.c_str());
    CHECK(std::strtod(limit.holds_to.c_str(), nullptr) >= limit.standard);
  }
  return limits;
}

std::string disordered(const std::string& scene) {
  return replaced(scene, "    material: {", "    arrangement: relaxed\n    material: {");
}

}  // namespace

TEST_CASE("the longest stable steps of fluids") {
  limits_of("fluid.wcsph, dam break", dam_break);
  limits_of("fluid.wcsph, dam break, disordered", disordered(dam_break));
  limits_of("fluid.least_squares, vortices, disordered", disordered(vortices));
}

TEST_CASE("the longest stable steps of solids") {
  for (const auto& [name, scene] :
       {std::pair{"solid.total_lagrangian, plate", plate},
        std::pair{"solid.total_lagrangian, plate, disordered", disordered(plate)}}) {
    const std::vector<Limit> limits = limits_of(name, scene);
    REQUIRE(limits.size() == 1);
    CHECK(limits[0].why == "the largest that is allowed");  // 1 is the limit of the undeformed body
  }
}

TEST_CASE("rk2 of diffusion holds to the step that it takes for the longest") {
  // Modes that grow start from nothing: in a hundred steps they show.
  const auto limits =
      limits_of("diffusion rk2, disordered plate", replaced(heat, "run: {end: 1}", "run: {end: 40}"));
  REQUIRE(limits.size() == 1);
  CHECK(limits[0].holds_to == "0.99");
  CHECK(limits[0].fails_at == "1.089");
}
