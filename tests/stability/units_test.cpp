// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The size of a scene is not its physics: scaled from metres to nanometres or kilometres by a power of two, which
// floating-point arithmetic does without rounding, each scene takes the same steps to the last bit. Any length,
// pressure or time that is written into the code as a number breaks this.
#include "tests/stability/scenes.hpp"

using namespace stability;

namespace {

void check_scaled(const char* name, const std::string& scene) {
  const auto label = [&](const char* size) { return std::string(name) + "_" + size; };
  const Result metres = run(scene, label("metres"));
  REQUIRE_MESSAGE(metres.code == 0, metres.err);
  const auto lengths = rows(label("metres") + "/probes/lengths.csv");
  REQUIRE(lengths.size() > 5);
  for (const auto& scaling : {std::pair{"nanometres", -30}, std::pair{"kilometres", 10}}) {
    // No structured binding: CAPTURE is a lambda, and clang 14 lets none use one.
    const char* const size = scaling.first;
    const int exponent = scaling.second;
    CAPTURE(name);
    CAPTURE(size);
    char scale[80];
    std::snprintf(scale, sizeof scale, "S=%.50g", std::ldexp(1.0, exponent));
    const Result scaled = run(scene, label(size), {"--set", scale});
    REQUIRE_MESSAGE(scaled.code == 0, scaled.err);
    CHECK(read(label(size) + "/probes/energy.csv") == read(label("metres") + "/probes/energy.csv"));
    const auto scaled_lengths = rows(label(size) + "/probes/lengths.csv");
    REQUIRE(scaled_lengths.size() == lengths.size());
    const bool potential = contains(scene, "concentration");  // which has no length
    for (std::size_t k = 0; k < lengths.size(); ++k)
      for (std::size_t c = 1; c < lengths[k].size(); ++c) {
        const int e = potential && c == 1 ? 0 : exponent;
        CHECK(scaled_lengths[k][c] == std::ldexp(lengths[k][c], e));
      }
  }
}

}  // namespace

TEST_CASE("a dam break of nanometres or kilometres is that of metres") { check_scaled("dam", dam_break); }
TEST_CASE("so are vortices of fluid.least_squares") { check_scaled("vortices", vortices); }
TEST_CASE("so is a plate that swings") { check_scaled("plate", plate); }
TEST_CASE("so is heat in a disordered plate") { check_scaled("heat", heat); }
