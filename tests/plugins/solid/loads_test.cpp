// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Loads and constraints of the solid plugin: a uniform pressure and the stress that belongs to it are in equilibrium on
// any arrangement, loads have the resultant that they should, and held particles stay.
#include <doctest/doctest.h>

#include <algorithm>

#include "constraints.hpp"
#include "damping.hpp"
#include "loads.hpp"
#include "momentum.hpp"
#include "particles.hpp"

using namespace shoal;
using namespace shoal::solid;
using solid_test::dx;

namespace {

constexpr double rho = 1500.0;

SharedStructure structure() {
  auto made = std::make_shared<Structure>();
  made->settings = solid_test::settings();
  made->constants.density = rho;
  return made;
}

testing::Setup setup(double dt = 0.0) {
  return {.smoothing_length = solid_test::settings().smoothing_length, .spacing = dx, .dt = dt};
}

template <int D>
testing::Body loaded_box(double disorder) {
  testing::Body body = solid_test::box(D, 9, disorder);
  body["position"] = body["reference_position"];
  body.set("mass", rho * std::pow(dx, D));
  body.set_each("deformation_gradient", D * D,
                [](std::size_t, std::size_t k) { return k % (D + 1) == 0 ? 1.0 : 0.0; });
  return body;
}

}  // namespace

TEST_CASE("area vectors balance a uniform stress to rounding") {
  const auto check = []<int D>() {
    testing::Body body = loaded_box<D>(0.2);
    const SharedStructure shared = structure();
    SurfaceArea area;
    area.structure = shared;
    testing::run(area, body, {&body}, setup());
    // P = -I, and the force of a unit pressure on the area vectors.
    body.set_each("piola_stress", D * D,
                  [](std::size_t, std::size_t k) { return k % (D + 1) == 0 ? -1.0 : 0.0; });
    InternalForce force;
    force.structure = shared;
    testing::run(force, body, {&body}, setup());
    const double volume = std::pow(dx, D);
    for (std::size_t k = 0; k < body.size() * D; ++k) {
      const double internal = rho * volume * body["internal_acceleration"][k];
      CHECK(std::fabs(internal - body["reference_area"][k]) < 1e-12 * std::pow(dx, D - 1));
    }
  };
  check.operator()<2>();
  check.operator()<3>();
}

TEST_CASE("held particles return to where they were, along the axes that are held") {
  testing::Body body = loaded_box<2>(0.0);
  for (double& x : body["position"]) x += 0.01;
  body.set_each("velocity", 2, [](std::size_t, std::size_t) { return 1.0; });
  PrescribedMotion op;
  op.axes = {true, false, true};
  testing::run(op, body, {}, setup(1e-3));
  for (std::size_t i = 0; i < body.size(); ++i) {
    CHECK(body["position"][2 * i] == body["reference_position"][2 * i]);
    CHECK(body["position"][2 * i + 1] == body["reference_position"][2 * i + 1] + 0.01);
    CHECK(body["velocity"][2 * i] == 0.0);
    CHECK(body["velocity"][2 * i + 1] == 1.0);
  }
}

TEST_CASE("Kelvin-Voigt damping does nothing to a rigid rotation and resists a stretch") {
  testing::Body body = loaded_box<2>(0.0);
  const double c = std::cos(0.3), s = std::sin(0.3), dt = 1e-3, w = 1e-3;
  // F turns by a small angle within the step: F = R(0.3 + w), before R(0.3). The rate of E is of second order in w.
  const double C = std::cos(0.3 + w), S = std::sin(0.3 + w);
  const double now[4] = {C, -S, S, C}, old[4] = {c, -s, s, c};
  body.set_each("deformation_gradient", 4, [&](std::size_t, std::size_t k) { return now[k]; });
  body.set_each("previous_deformation_gradient", 4, [&](std::size_t, std::size_t k) { return old[k]; });
  body.set_each("piola_stress", 4, [](std::size_t, std::size_t) { return 0.0; });
  KelvinVoigt op;
  op.viscosity = 2.0;
  testing::run(op, body, {}, setup(dt));
  for (std::size_t k = 0; k < 4; ++k) CHECK(std::fabs(body["piola_stress"][k]) < 2.0 * 2.0 * w * w / dt);
  // A stretch at the rate 1/s along x: P = 2 eta dE/dt = 2 eta for F near one.
  body.set_each("deformation_gradient", 4, [&](std::size_t, std::size_t k) {
    return k == 0 ? 1.0 + dt : k == 3 ? 1.0 : 0.0;
  });
  body.set_each("previous_deformation_gradient", 4,
                [](std::size_t, std::size_t k) { return k % 3 == 0 ? 1.0 : 0.0; });
  body.set_each("piola_stress", 4, [](std::size_t, std::size_t) { return 0.0; });
  testing::run(op, body, {}, setup(dt));
  CHECK(body["piola_stress"][0] == doctest::Approx(4.0).epsilon(0.01));
  CHECK(body["piola_stress"][1] == 0.0);
  CHECK(body["piola_stress"][3] == 0.0);
}

TEST_CASE("pair damping slows neighbours that approach, and keeps momentum and angular momentum") {
  testing::Body body = loaded_box<2>(0.2);
  body.set_each("velocity", 2,
                [](std::size_t i, std::size_t a) { return std::sin(7.0 * static_cast<double>(2 * i + a)); });
  PairDamping op;
  op.strength = 0.3;
  testing::run(op, body, {&body}, setup());
  const std::vector<double> packs = body["acceleration"];
  double force[2] = {}, moment = 0, power = 0, scale = 0;
  for (std::size_t i = 0; i < body.size(); ++i) {
    const double *x = &body["position"][2 * i], *a = &packs[2 * i], *v = &body["velocity"][2 * i];
    for (std::size_t k = 0; k < 2; ++k) {
      force[k] += a[k];
      power += a[k] * v[k];
      scale += std::fabs(a[k]);
    }
    moment += x[0] * a[1] - x[1] * a[0];
  }
  CHECK(std::fabs(force[0]) < 1e-12 * scale);
  CHECK(std::fabs(force[1]) < 1e-12 * scale);
  CHECK(std::fabs(moment) < 1e-12 * scale);
  CHECK(power < -0.1 * scale);
  // The slow way: one neighbour after the other.
  std::fill(body["acceleration"].begin(), body["acceleration"].end(), 0.0);
  testing::Setup scalar = setup();
  scalar.scalar = true;
  PairDamping again;
  again.strength = 0.3;
  testing::run(again, body, {&body}, scalar);
  for (std::size_t k = 0; k < packs.size(); ++k)
    CHECK(std::fabs(packs[k] - body["acceleration"][k]) < 1e-12 * scale / static_cast<double>(body.size()));
}
