// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Density, viscosity, shift, the acoustic step and the equations of state.
#include <doctest/doctest.h>

#include "acoustic_step.hpp"
#include "advection_step.hpp"
#include "density.hpp"
#include "lattice.hpp"
#include "liquid.hpp"
#include "particles.hpp"
#include "viscosity.hpp"

using namespace shoal;
using namespace shoal::fluid;
using namespace shoal::fluid::test;

namespace {
constexpr double dx = 0.05, h = 1.3 * dx, rho0 = 1000.0;

LatticeSums sums_on_lattice(int dimensions) {
  Target target;
  target.smoothing_length = h;
  target.spacing = dx;
  return lattice_sums(dimensions, target);
}

// Particles whose whole support lies in [0, 1)^D.
bool inside(Body& body, std::size_t i) {
  const auto d = static_cast<std::size_t>(body.dimensions());
  for (std::size_t a = 0; a < d; ++a) {
    const double x = body["position"][i * d + a];
    if (x < 2 * h || x > 1 - 2 * h) return false;
  }
  return true;
}
}  // namespace

TEST_CASE("a lattice has the density at rest, next to a wall too; at a free surface density is kept") {
  Body water(2, lattice(2, dx, {0, 0}, {1, 1}));
  Body wall(2, lattice(2, dx, {0, -0.2}, {1, 0}));
  wall.set("volume", dx * dx);
  water.set("density", 1004.0);
  water.set("mass", rho0 * dx * dx);
  WallDensity walls;
  DensityReinitialisationAtWalls op;
  op.reference_density = rho0;
  op.per_lattice_sum = 1.0 / sums_on_lattice(2).w;
  testing::run(walls, water, {&wall}, {.smoothing_length = h});
  testing::run(op, water, {&water}, {.smoothing_length = h});
  for (std::size_t i = 0; i < water.size(); ++i) {
    const double x = water["position"][2 * i], y = water["position"][2 * i + 1];
    const bool full_support = x > 2 * h && x < 1 - 2 * h && y < 1 - 2 * h;
    const double density = water["density"][i];
    // rho_s + max(0, rho - rho_s) rho0 / rho with rho_s = rho0 is rho0 (1 + (rho - rho0) / rho).
    if (full_support) CHECK(density == doctest::Approx(rho0 + 4.0 * rho0 / 1004.0).epsilon(1e-12));
    if (y > 1 - 0.6 * dx) {
      CHECK(density > rho0);
      CHECK(density < 1004.0);
    }
    CHECK(water["volume"][i] == doctest::Approx(rho0 * dx * dx / density).epsilon(1e-14));
  }
  op.free_surface = false;
  testing::run(op, water, {&water}, {.smoothing_length = h});
  for (std::size_t i = 0; i < water.size(); ++i)
    if (inside(water, i)) CHECK(water["density"][i] == doctest::Approx(rho0).epsilon(1e-12));
}

TEST_CASE("density follows compression of the particles") {
  for (const double squeeze : {0.99, 0.9}) {
    Body water(3, lattice(3, dx, {0, 0, 0}, {0.6, 0.6, 0.6}));
    for (std::size_t k = 0; k < water.size(); ++k) water["position"][3 * k + 2] *= squeeze;
    water.set("density", rho0);
    water.set("mass", rho0 * dx * dx * dx);
    DensityReinitialisation op;
    op.reference_density = rho0;
    op.per_lattice_sum = 1.0 / sums_on_lattice(3).w;
    op.free_surface = false;
    testing::run(op, water, {&water}, {.smoothing_length = h});
    for (std::size_t i = 0; i < water.size(); ++i) {
      const double* x = &water["position"][3 * i];
      if (std::abs(x[0] - 0.3) + std::abs(x[1] - 0.3) < 0.06 && std::abs(x[2] - 0.3 * squeeze) < 0.03)
        CHECK(water["density"][i] == doctest::Approx(rho0 / squeeze).epsilon(0.02));
    }
  }
}

TEST_CASE(
    "viscosity: nothing in uniform and in linear shear flow, nu u'' in a parabola; the same at a no-slip "
    "wall") {
  Body water(2, lattice(2, dx, {0, 0}, {1, 1}));
  Body wall(2, lattice(2, dx, {0, -0.2}, {1, 0}));
  water.set("volume", dx * dx);
  water.set("density", rho0);
  set_masses(water);
  wall.set("volume", dx * dx);
  wall.set_each("normal", 2, [](auto, auto a) { return a == 1 ? 1.0 : 0.0; });
  wall.set_each("signed_distance", 1, [&](auto j, auto) { return wall["position"][2 * j + 1]; });
  const auto accelerations = [&](auto profile) {
    water.set_each("velocity", 2,
                   [&](auto i, auto a) { return a == 0 ? profile(water["position"][2 * i + 1]) : 0.0; });
    wall.set_each("velocity", 2, [&](auto, auto a) { return a == 0 ? profile(0.0) : 0.0; });
    water.set_each("acceleration", 2, [](auto, auto) { return 0.0; });
    ViscousForce inner;
    inner.viscosity = 2.0;
    inner.reference_density = rho0;
    inner.gradient_scale = 1.0 / sums_on_lattice(2).slope;
    WallViscousForce walls;
    walls.viscosity = 2.0;
    walls.gradient_scale = inner.gradient_scale;
    testing::run(inner, water, {&water}, {.smoothing_length = h});
    testing::run(walls, water, {&wall}, {.smoothing_length = h});
  };
  const auto supported = [&](std::size_t i) {
    const double x = water["position"][2 * i], y = water["position"][2 * i + 1];
    return x > 2 * h && x < 1 - 2 * h && y < 1 - 2 * h;
  };
  const auto check_each = [&](double wanted, double absolute) {
    int n = 0;
    for (std::size_t i = 0; i < water.size(); ++i)
      if (supported(i) && ++n) CHECK(std::abs(water["acceleration"][2 * i] - wanted) < absolute);
    CHECK(n > 100);
  };
  accelerations([](double) { return 3.0; });
  check_each(0.0, 1e-14);
  accelerations([](double y) { return 3.0 - 2.0 * y; });
  check_each(0.0, 1e-12);
  accelerations([](double y) { return y * y; });
  const double nu = 2.0 / rho0;
  for (std::size_t i = 0; i < water.size(); ++i)
    if (inside(water, i)) CHECK(water["acceleration"][2 * i] == doctest::Approx(2.0 * nu).epsilon(1e-12));
}

TEST_CASE("the shift moves particles apart, leaves a lattice alone, and is bounded") {
  Body water(2, lattice(2, dx, {0, 0}, {1, 1}));
  water.set("volume", dx * dx);
  TransportShift op;
  testing::run(op, water, {&water}, {.smoothing_length = h, .spacing = dx});
  for (std::size_t i = 0; i < water.size(); ++i)
    if (inside(water, i)) CHECK(std::abs(water["transport_shift"][2 * i]) < 1e-12 * dx);

  Body close(2, {0.0, 0.0, 0.3 * dx, 0.0});
  close.set("volume", dx * dx);
  testing::run(op, close, {&close}, {.smoothing_length = h, .spacing = dx});
  CHECK(close["transport_shift"][0] < 0.0);
  CHECK(close["transport_shift"][2] == doctest::Approx(-close["transport_shift"][0]));
  close["transport_shift"] = {dx, 0.0, -dx, 0.0};
  ApplyShift apply;
  testing::run(apply, close, {}, {.spacing = dx});
  CHECK(close["position"][0] == doctest::Approx(0.1 * dx));
  CHECK(close["position"][2] == doctest::Approx(0.2 * dx));
}

// A sound wave of wave number kappa / h through many steps of length C h / c, with lengths in h and speeds in c; whether its
// amplitude stays what it is. `rate` is the dissipation of pressure jumps in c / h.
bool wave_stays_bounded(double kappa, double C, double damping, double rate) {
  double rho = 1.0, velocity = 0.0, compression = 0.0, diffusion = 0.0;
  for (int k = 0; k < 5000; ++k) {
    rho += 0.5 * C * (compression + diffusion);
    const double pressure = rho + damping * compression;
    diffusion = -rate * rho;
    velocity += C * kappa * pressure;  // of a standing wave: a quarter of a period out of phase
    compression = -kappa * velocity;
    rho += 0.5 * C * (compression + diffusion);
  }
  return std::abs(rho) < 2.0;
}

TEST_CASE("acoustic steps are as long as sound and what damps it bear") {
  for (const double damping : {0.0, 0.3, 0.5, 1.2}) {
    const double longest = longest_acoustic_step(damping, 0.0);
    CAPTURE(damping);
    CHECK(wave_stays_bounded(1.5, 0.99 * longest, damping, 0.0));
    CHECK_FALSE(wave_stays_bounded(1.5, 1.01 * longest, damping, 0.0));
  }
  const double longest = longest_acoustic_step(0.3, 1.0);
  CHECK(longest < longest_acoustic_step(0.3, 0.4));
  CHECK(wave_stays_bounded(0.0, 0.99 * longest, 0.3, 3.0));
  CHECK_FALSE(wave_stays_bounded(0.0, 1.01 * longest, 0.3, 3.0));
}

TEST_CASE("the acoustic step is position-based Verlet") {
  Liquid liquid;
  liquid.density = rho0;
  const EquationOfState eos{
      static_cast<const shoal_equation_of_state*>(liquid.interface("equation_of_state", 1)),
      static_cast<Material*>(&liquid)};
  REQUIRE(eos);
  liquid.equation_of_state = Choice{"linear"};
  CHECK(eos.api->set_sound_speed(eos.self, 20.0) == 20.0);

  Body water(2, {0.1, 0.2});
  water.set("mass", 2.5);
  water["density"] = {1001.0};
  water["compression_rate"] = {60.0};
  water["density_diffusion"] = {40.0};
  water["velocity"] = {1.0, -2.0};
  water["acceleration"] = {0.0, -10.0};
  water["pressure_acceleration"] = {5.0, 0.0};
  const Setup step{.smoothing_length = h, .spacing = dx, .dt = 0.01};
  AcousticPredictor predict;
  predict.equation_of_state = eos;
  predict.sound_speed = 20.0;
  predict.damping = 0.25;
  testing::run(predict, water, {}, step);
  CHECK(water["density"][0] == doctest::Approx(1001.5).epsilon(1e-14));
  CHECK(water["pressure"][0] == doctest::Approx(400.0 * 1.5 + 0.25 * 20.0 * h * 60.0).epsilon(1e-12));
  CHECK(water["volume"][0] == doctest::Approx(2.5 / 1001.5).epsilon(1e-14));
  CHECK(water["position"][0] == doctest::Approx(0.105).epsilon(1e-14));
  CHECK(predict.time_step_of_block<2>(0, 1) == doctest::Approx(predict.cfl * h / (20.0 + std::sqrt(5.0))));
  Kick kick;
  testing::run(kick, water, {}, step);
  CHECK(water["velocity"][0] == doctest::Approx(1.05).epsilon(1e-14));
  CHECK(water["velocity"][1] == doctest::Approx(-2.1).epsilon(1e-14));
  CHECK(water["position"][0] == doctest::Approx(0.105 + 0.005 * 1.05).epsilon(1e-14));
  DensityCorrector correct;
  testing::run(correct, water, {}, step);
  CHECK(water["density"][0] == doctest::Approx(1002.0).epsilon(1e-14));
}

TEST_CASE("the largest speed of a block, wherever it is, and a NaN anywhere") {
  std::vector<double> v(3 * 21 + 1);  // in the plane a block of two ends there
  for (std::size_t k = 0; k < v.size(); ++k) v[k] = std::sin(static_cast<double>(k));
  for (std::uint64_t fastest = 2; fastest < 21; ++fastest) {
    std::vector<double> with = v;
    with[3 * fastest] = 3.0, with[3 * fastest + 1] = 4.0, with[3 * fastest + 2] = -12.0;
    CHECK(largest_speed<3>(with.data(), 2, 21) == 13.0);
    CHECK(largest_speed<3>(with.data(), 2, fastest) < 2.0);
    CHECK(largest_speed<2>(with.data(), fastest * 3 / 2, fastest * 3 / 2 + 2) >= 5.0);
    with[3 * fastest + 1] = std::nan("");
    CHECK(std::isnan(largest_speed<3>(with.data(), 2, 21)));
  }
  CHECK(largest_speed<3>(v.data(), 4, 4) == 0.0);
}

TEST_CASE("equations of state and their inverses agree, with the sound speed as slope") {
  for (const char* kind : {"linear", "tait"}) {
    CAPTURE(kind);
    Liquid liquid;
    liquid.density = rho0;
    liquid.exponent = 7.0;
    liquid.equation_of_state = Choice{kind};
    const auto* api = static_cast<const shoal_equation_of_state*>(liquid.interface("equation_of_state", 1));
    void* self = static_cast<Material*>(&liquid);
    api->set_sound_speed(self, 30.0);
    const std::vector<double> rho{rho0, 1003.0, 990.0, rho0 * (1 + 1e-6)};
    std::vector<double> p(4), back(4);
    api->pressure(self, 4, rho.data(), p.data());
    api->density(self, 4, p.data(), back.data());
    CHECK(std::abs(p[0]) < 1e-9);
    for (std::size_t k = 0; k < 4; ++k) CHECK(back[k] == doctest::Approx(rho[k]).epsilon(1e-13));
    CHECK(p[3] / (rho[3] - rho[0]) == doctest::Approx(900.0).epsilon(1e-4));
  }
  CHECK(Liquid().interface("equation_of_state", 2) == nullptr);
  CHECK(Liquid().interface("stress_law", 1) == nullptr);
}
