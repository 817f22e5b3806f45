// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What the shift adds to velocities: exact for linear ones, along the shift as it is bounded, nothing in a spray.
#include <doctest/doctest.h>

#include "particles.hpp"
#include "shift_carry.hpp"

using namespace shoal;
using namespace shoal::fluid;
using namespace shoal::fluid::test;

namespace {

constexpr double dx = 0.1;

}  // namespace

TEST_CASE("a linear velocity is carried along the shift exactly") {
  constexpr double L[3][3] = {{0.7, -2.0, 0.5}, {3.0, -0.4, 1.0}, {0.2, -0.6, 0.9}};
  for (const int dimensions : {2, 3})
    for (const bool scalar : {false, true}) {
      const auto d = static_cast<std::size_t>(dimensions);
      Body body(dimensions, lattice(dimensions, dx, {0, 0, 0}, std::vector<double>(d, 0.8), 0.2));
      body.set("volume", std::pow(dx, dimensions));
      const auto x = body["position"];
      const auto times_L = [&](const double* of, std::size_t a) {
        double sum = 0;
        for (std::size_t b = 0; b < d; ++b) sum += L[a][b] * of[b];
        return sum;
      };
      body.set_each("velocity", d, [&](std::size_t i, std::size_t a) { return 0.3 + times_L(&x[i * d], a); });
      // Some shorter than a tenth of the spacing, some longer
      body.set_each("transport_shift", d, [](std::size_t i, std::size_t a) {
        return 0.02 * std::sin(static_cast<double>(3 * i + a));
      });
      const auto shift = body["transport_shift"];
      ShiftChange op;
      Setup setup;
      setup.smoothing_length = 1.3 * dx;
      setup.spacing = dx;
      setup.scalar = scalar;
      shoal::testing::run(op, body, {&body}, setup);
      for (std::size_t i = 0; i < body.size(); ++i) {
        double length = 0;
        for (std::size_t a = 0; a < d; ++a) length += shift[i * d + a] * shift[i * d + a];
        const double factor = std::min(1.0, 0.1 * dx / std::sqrt(length));
        for (std::size_t a = 0; a < d; ++a)
          CHECK(body["shift_velocity_change"][i * d + a] ==
                doctest::Approx(factor * times_L(&shift[i * d], a)).epsilon(1e-9));
      }
    }
}

TEST_CASE("where neighbours do not span the plane, the shift carries nothing") {
  Body body(2, {0, 0, 0.1, 0, 0.2, 0, 5, 5});
  body.set("volume", dx * dx);
  body.set_each("velocity", 2, [](std::size_t i, std::size_t) { return static_cast<double>(i); });
  body.set_each("transport_shift", 2, [](std::size_t, std::size_t) { return 0.01; });
  ShiftChange op;
  Setup setup;
  setup.smoothing_length = 1.3 * dx;
  setup.spacing = dx;
  shoal::testing::run(op, body, {&body}, setup);
  for (const double change : body["shift_velocity_change"]) CHECK(change == 0.0);
}
