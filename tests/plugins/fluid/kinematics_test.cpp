// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Vorticity and Q-criterion of linear velocities, whose gradient is known; in 2D and 3D, with packs and without.
#include <doctest/doctest.h>

#include "kinematics.hpp"
#include "particles.hpp"

using namespace shoal;
using namespace shoal::fluid;
using namespace shoal::fluid::test;

namespace {

constexpr double dx = 0.1;

Body in_linear_flow(int d, const double (&L)[3][3]) {
  const std::vector<double> upper(static_cast<std::size_t>(d), 0.8);
  Body body(d, lattice(d, dx, {0, 0, 0}, upper, 0.2));
  body.set("volume", std::pow(dx, d));
  const auto x = body["position"];
  body.set_each("velocity", static_cast<std::size_t>(d), [&](std::size_t i, std::size_t a) {
    double v = 0.3;
    for (std::size_t b = 0; b < static_cast<std::size_t>(d); ++b)
      v += L[a][b] * x[i * static_cast<std::size_t>(d) + b];
    return v;
  });
  return body;
}

Setup setup(bool scalar) {
  Setup how;
  how.smoothing_length = 1.3 * dx;
  how.spacing = dx;
  how.scalar = scalar;
  return how;
}

}  // namespace

TEST_CASE("vorticity and Q of a linear flow in the plane") {
  const double L[3][3] = {{0.7, -2.0, 0}, {3.0, -0.4, 0}, {0, 0, 0}};
  for (const bool scalar : {false, true}) {
    Body body = in_linear_flow(2, L);
    Kinematics<Scalar> op;
    shoal::testing::run(op, body, {&body}, setup(scalar));
    for (std::size_t i = 0; i < body.size(); ++i) {
      CHECK(body["vorticity"][i] == doctest::Approx(5.0).epsilon(1e-9));
      CHECK(body["q_criterion"][i] == doctest::Approx(-0.28 + 6.0).epsilon(1e-9));  // the determinant
    }
  }
}

TEST_CASE("vorticity and Q of a linear flow in space") {
  const double L[3][3] = {{0.7, -2.0, 0.5}, {3.0, -0.4, 1.0}, {0.2, -0.6, 0.9}};
  double trace = 0, square = 0;
  for (int a = 0; a < 3; ++a) {
    trace += L[a][a];
    for (int b = 0; b < 3; ++b) square += L[a][b] * L[b][a];
  }
  for (const bool scalar : {false, true}) {
    Body body = in_linear_flow(3, L);
    Kinematics<Vector> op;
    shoal::testing::run(op, body, {&body}, setup(scalar));
    for (std::size_t i = 0; i < body.size(); ++i) {
      CHECK(body["vorticity"][3 * i] == doctest::Approx(-1.6).epsilon(1e-9));
      CHECK(body["vorticity"][3 * i + 1] == doctest::Approx(0.3).epsilon(1e-9));
      CHECK(body["vorticity"][3 * i + 2] == doctest::Approx(5.0).epsilon(1e-9));
      CHECK(body["q_criterion"][i] == doctest::Approx(0.5 * (trace * trace - square)).epsilon(1e-9));
    }
  }
}

TEST_CASE("particles without enough neighbours have no vorticity") {
  Body body(2, {0, 0, 0.1, 0, 0.2, 0, 5, 5});
  body.set("volume", dx * dx);
  body.set_each("velocity", 2, [](std::size_t i, std::size_t) { return static_cast<double>(i); });
  Kinematics<Scalar> op;
  shoal::testing::run(op, body, {&body}, setup(false));
  for (std::size_t i = 0; i < body.size(); ++i) {
    CHECK(body["vorticity"][i] == 0.0);
    CHECK(body["q_criterion"][i] == 0.0);
  }
}
