// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Corrected gradients: exact for linear fields, and the corrected sums against plain loops.
#include "gradient_matrix.hpp"

#include <doctest/doctest.h>

#include "particles.hpp"
#include "riemann.hpp"
#include "wall.hpp"

using namespace shoal;
using namespace shoal::fluid;
using namespace shoal::fluid::test;

namespace {

constexpr double dx = 0.1, h = 1.3 * dx, rho0 = 1000.0, c = 12.0;

Body water(int dimensions) {
  Body body(dimensions, dimensions == 2 ? lattice(2, dx, {0, 0}, {1, 1}, 0.2)
                                        : lattice(3, dx, {0, 0, 0}, {0.6, 0.6, 0.6}, 0.2));
  body.set("volume", std::pow(dx, dimensions));
  body.set("density", rho0);
  set_masses(body);
  return body;
}

// Distance from the block's sides.
double depth(Body& body, std::size_t i, std::size_t d) {
  double least = 1.0;
  for (std::size_t a = 0; a < d; ++a) {
    const double x = body["position"][i * d + a], side = d == 2 ? 1.0 : 0.6;
    least = std::min({least, x, side - x});
  }
  return least;
}

}  // namespace

TEST_CASE("corrected divergence is exact for linear velocities, at free surfaces too") {
  for (const int dimensions : {2, 3}) {
    const auto d = static_cast<std::size_t>(dimensions);
    Body body = water(dimensions);
    auto& x = body["position"];
    body.set_each("velocity", d, [&](auto i, auto a) {
      return 0.3 + (1.0 + static_cast<double>(a)) * x[i * d + a] - 2.0 * x[i * d + (a + 1) % d];
    });
    GradientMoment moment;
    testing::run(moment, body, {&body}, {.smoothing_length = h});
    GradientMatrix matrix;
    testing::run(matrix, body, {}, {.smoothing_length = h, .spacing = dx});
    VelocityDivergenceOf<true> op;
    op.sound_speed = c;
    testing::run(op, body, {&body}, {.smoothing_length = h});
    const double wanted = -rho0 * (dimensions == 2 ? 3.0 : 6.0);
    std::size_t exact = 0;
    for (std::size_t i = 0; i < body.size(); ++i)
      exact += std::abs(body["compression_rate"][i] - wanted) < 1e-9 * rho0;
    // All but those at the block's edges in 3D and corners, where it goes over to the lattice's correction.
    CHECK(exact > body.size() * 3 / 4);
    for (std::size_t i = 0; i < body.size(); ++i)
      if (depth(body, i, d) > dx)
        CHECK(body["compression_rate"][i] == doctest::Approx(wanted).epsilon(1e-12));
  }
}

TEST_CASE("a particle with too few neighbours has the lattice's correction") {
  Body pair(2, {0.0, 0.0, 0.1, 0.0});
  pair.set("volume", dx * dx);
  GradientMoment moment;
  testing::run(moment, pair, {&pair}, {.smoothing_length = h});
  GradientMatrix matrix;
  matrix.slope = 0.8;
  testing::run(matrix, pair, {}, {.smoothing_length = h});
  for (const char* name : {"gradient_matrix", "pressure_matrix"})
    for (std::size_t k = 0; k < 8; ++k)
      CHECK(pair[name][k] == doctest::Approx(k % 4 == 0 || k % 4 == 3 ? 1.25 : 0.0));
}

TEST_CASE("corrected pressure force equals the plain sum, and keeps momentum") {
  for (const int dimensions : {2, 3}) {
    const auto d = static_cast<std::size_t>(dimensions);
    Body body = water(dimensions);
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    body.set_each("pressure", 1, [&](auto, auto) { return 500.0 * uniform(random); });
    body.set_each("pressure_matrix", d * d, [&](auto, auto) { return uniform(random); });
    body.set_each("last_pressure_acceleration", d, [](auto, auto) { return 0.0; });
    std::vector<double> wanted(body.size() * d, 0.0), total(d, 0.0);
    for_all_pairs(body, body, 2 * h, [&](auto i, auto j, double r, const auto& e) {
      for (std::size_t a = 0; a < d; ++a)
        for (std::size_t b = 0; b < d; ++b)
          wanted[i * d + a] -= body["volume"][j] / rho0 * plain_dw(dimensions, h, r) * e[b] *
                               (body["pressure"][i] * body["pressure_matrix"][(j * d + a) * d + b] +
                                body["pressure"][j] * body["pressure_matrix"][(i * d + a) * d + b]);
    });
    PressureForceOf<true> op;
    op.reference_density = rho0;
    op.sound_speed = c;
    testing::run(op, body, {&body}, {.smoothing_length = h});
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      REQUIRE(body["pressure_acceleration"][k] == doctest::Approx(wanted[k]).epsilon(1e-10).scale(1.0));
      total[k % d] += body["pressure_acceleration"][k];
    }
    for (const double sum : total) CHECK(std::abs(sum) < 1e-9);
  }
}

TEST_CASE("walls take part in the correction: next to one it is that of the interior") {
  Body fluid(2, lattice(2, dx, {0, 0}, {1, 1})), wall(2, lattice(2, dx, {-0.4, -0.4}, {1.4, 0}));
  fluid.set("volume", dx * dx);
  wall.set("volume", dx * dx);
  GradientMoment moment;
  testing::run(moment, fluid, {&fluid}, {.smoothing_length = h});
  WallGradientMoment walls;
  testing::run(walls, fluid, {&wall}, {.smoothing_length = h});
  const std::size_t low = 5, middle = 55;  // (0.55, 0.05) and (0.55, 0.55)
  for (std::size_t k = 0; k < 4; ++k)
    CHECK(fluid["gradient_matrix"][4 * low + k] ==
          doctest::Approx(fluid["gradient_matrix"][4 * middle + k]).epsilon(1e-12).scale(1.0));
}
