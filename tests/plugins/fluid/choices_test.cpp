// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The choices of fluid.wcsph, density diffusion, artificial and central viscosity, shifting at free surfaces, against
// plain double loops, and what they conserve.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "central_viscosity.hpp"
#include "density_diffusion.hpp"
#include "particles.hpp"
#include "surface_shift.hpp"

using namespace shoal;
using namespace shoal::fluid;
using namespace shoal::fluid::test;

namespace {

constexpr double dx = 0.1, h = 1.3 * dx, c = 20.0, rho0 = 1000.0;

Body disordered(int dimensions) {
  const auto d = static_cast<std::size_t>(dimensions);
  Body body(dimensions, lattice(dimensions, dx, std::vector<double>(d, 0.0),
                                std::vector<double>(d, dimensions == 2 ? 1.0 : 0.6), 0.2));
  const auto wavy = [](std::size_t i, double k) { return std::sin(k * static_cast<double>(i) + k); };
  body.set_each("pressure", 1, [&](std::size_t i, std::size_t) { return 3000.0 * wavy(i, 1.7); });
  body.set_each("density", 1, [&](std::size_t i, std::size_t) { return rho0 + 8.0 * wavy(i, 1.7); });
  body.set_each("volume", 1, [&](std::size_t i, std::size_t) {
    return std::pow(dx, dimensions) * (1.0 + 0.02 * wavy(i, 0.9));
  });
  set_masses(body);
  body.set_each("velocity", d, [&](std::size_t i, std::size_t a) { return wavy(i, 2.1 + double(a)); });
  body.set_each("last_pressure_acceleration", d,
                [&](std::size_t i, std::size_t a) { return 9.0 * wavy(i, 0.4 + double(a)); });
  body.set_each("pressure_acceleration", d, [](std::size_t, std::size_t) { return 0.0; });
  body.set_each("acceleration", d, [](std::size_t, std::size_t) { return 0.0; });
  return body;
}

void check_equal(const std::vector<double>& a, const std::vector<double>& b, double tolerance) {
  REQUIRE(a.size() == b.size());
  double size = 0;
  for (const double value : b) size = std::max(size, std::abs(value));
  for (std::size_t k = 0; k < a.size(); ++k) CHECK(std::abs(a[k] - b[k]) <= tolerance * size);
}

template <class Check>
void in_all_ways(Check&& check) {
  for (const int dimensions : {2, 3})
    for (const bool scalar : {false, true}) {
      CAPTURE(dimensions);
      CAPTURE(scalar);
      check(dimensions, Setup{.smoothing_length = h, .spacing = dx, .scalar = scalar});
    }
}

// Force and diffusion by the sums of the papers; `explained` is what S_ij takes off p_i - p_j.
template <Diffusion Kind, class Explained>
void check_diffusion(int dimensions, const Setup& setup, Explained&& explained) {
  Body body = disordered(dimensions);
  const auto d = static_cast<std::size_t>(dimensions);
  const double diffusivity = 0.07;
  std::vector<double> force(body.size() * d, 0.0), rate(body.size(), 0.0);
  for_all_pairs(body, body, 2 * h, [&](auto i, auto j, double r, const auto& e) {
    const double v = body["volume"][j], dw = plain_dw(dimensions, h, r);
    for (std::size_t a = 0; a < d; ++a)
      force[i * d + a] -= v * (body["pressure"][i] + body["pressure"][j]) / body["density"][i] * dw * e[a];
    const double jump = body["pressure"][i] - body["pressure"][j] - explained(body, i, j, r, e);
    if (Kind != Diffusion::none) rate[i] += 2.0 * diffusivity * v * jump / (c * c) * dw / r;
  });
  DiffusivePressureForce<Kind, false> op;
  op.reference_density = rho0;
  op.sound_speed = c;
  op.diffusivity = diffusivity;
  op.gravity = {0.3, -9.81, 0.1};
  testing::run(op, body, {&body}, setup);
  check_equal(body["pressure_acceleration"], force, 1e-13);
  check_equal(body["density_diffusion"], rate, 1e-13);
}

}  // namespace

TEST_CASE("density diffusion and the plain force equal the sums of the papers") {
  in_all_ways([](int dimensions, const Setup& setup) {
    const auto nothing = [](auto&&...) { return 0.0; };
    check_diffusion<Diffusion::none>(dimensions, setup, nothing);
    check_diffusion<Diffusion::edac>(dimensions, setup, nothing);
    const auto d = static_cast<std::size_t>(dimensions);
    check_diffusion<Diffusion::antuono>(
        dimensions, setup, [d](Body& b, auto i, auto j, double r, const auto& e) {
          double along = 0;
          for (std::size_t a = 0; a < d; ++a)
            along +=
                0.5 * r * e[a] *
                (b["last_pressure_acceleration"][i * d + a] + b["last_pressure_acceleration"][j * d + a]);
          return -rho0 * along;
        });
    check_diffusion<Diffusion::fourtakas>(dimensions, setup, [d](Body&, auto, auto, double r, const auto& e) {
      const double g[] = {0.3, -9.81, 0.1};
      double along = 0;
      for (std::size_t a = 0; a < d; ++a) along += g[a] * r * e[a];
      return rho0 * along;
    });
  });
}

TEST_CASE("water at rest feels no diffusion in the forms of Antuono and of Fourtakas, but that of edac") {
  Body body = disordered(2);
  const double g = 9.81;
  body.set_each("pressure", 1,
                [&](std::size_t i, std::size_t) { return -rho0 * g * body["position"][2 * i + 1]; });
  body.set_each("last_pressure_acceleration", 2,
                [&](std::size_t, std::size_t a) { return a == 1 ? g : 0.0; });
  const auto largest = [&]<class Op>(Op op) {
    Body at_rest = body;
    op.reference_density = rho0, op.sound_speed = c, op.diffusivity = 1.0, op.gravity = {0.0, -g, 0.0};
    testing::run(op, at_rest, {&at_rest}, {.smoothing_length = h, .spacing = dx});
    double most = 0;
    for (const double rate : at_rest["density_diffusion"]) most = std::max(most, std::abs(rate));
    return most;
  };
  const double without = largest(DiffusivePressureForce<Diffusion::edac, false>{});
  CHECK(without > 10.0);
  CHECK(largest(DiffusivePressureForce<Diffusion::antuono, false>{}) < 1e-12 * without);
  CHECK(largest(DiffusivePressureForce<Diffusion::fourtakas, false>{}) < 1e-12 * without);
}

TEST_CASE("divergence and artificial viscosity equal the sums of the papers") {
  in_all_ways([](int dimensions, const Setup& setup) {
    Body body = disordered(dimensions);
    const auto d = static_cast<std::size_t>(dimensions);
    std::vector<double> force(body.size() * d, 0.0), rate(body.size(), 0.0);
    for_all_pairs(body, body, 2 * h, [&](auto i, auto j, double r, const auto& e) {
      const double v = body["volume"][j], dw = plain_dw(dimensions, h, r);
      double v_r = 0;
      for (std::size_t a = 0; a < d; ++a)
        v_r += (body["velocity"][i * d + a] - body["velocity"][j * d + a]) * r * e[a];
      rate[i] += body["density"][i] * v * v_r / r * dw;
      if (v_r < 0)
        for (std::size_t a = 0; a < d; ++a)
          force[i * d + a] +=
              0.02 * c * h * rho0 / body["density"][i] * v * v_r / (r * r + 0.01 * h * h) * dw * e[a];
    });
    ViscousDivergence<false> op;
    op.alpha = 0.02;
    op.sound_speed = c;
    op.reference_density = rho0;
    testing::run(op, body, {&body}, setup);
    check_equal(body["pressure_acceleration"], force, 1e-13);
    check_equal(body["compression_rate"], rate, 1e-13);
  });
}

TEST_CASE(
    "the central viscous force equals its sum, keeps angular momentum, and is nu lap v in a shear flow") {
  in_all_ways([](int dimensions, const Setup& setup) {
    Body body = disordered(dimensions);
    const auto d = static_cast<std::size_t>(dimensions);
    const double eta = 2.5;
    std::vector<double> force(body.size() * d, 0.0);
    for_all_pairs(body, body, 2 * h, [&](auto i, auto j, double r, const auto& e) {
      double v_r = 0;
      for (std::size_t a = 0; a < d; ++a)
        v_r += (body["velocity"][i * d + a] - body["velocity"][j * d + a]) * r * e[a];
      for (std::size_t a = 0; a < d; ++a)
        force[i * d + a] += 2.0 * (dimensions + 2) * eta / body["density"][i] * body["volume"][j] * v_r /
                            (r * r) * plain_dw(dimensions, h, r) * e[a];
    });
    CentralViscousForce op;
    op.viscosity = eta;
    op.reference_density = rho0;
    testing::run(op, body, {&body}, setup);
    check_equal(body["acceleration"], force, 1e-13);
    double torque = 0, size = 0;
    for (std::size_t i = 0; i < body.size(); ++i) {
      const double m = body["mass"][i], *x = &body["position"][i * d], *a = &body["acceleration"][i * d];
      torque += m * (x[0] * a[1] - x[1] * a[0]);
      size += std::abs(m * x[0] * a[1]);
    }
    CHECK(std::abs(torque) < 1e-13 * size);
  });
  // u = y^2: nu lap u = 2 nu, on a fine lattice with many neighbours
  const double fine = 0.05, wide = 4.0 * fine;
  Body body(2, lattice(2, fine, {0, 0}, {1.5, 1.5}));
  body.set_each("density", 1, [](std::size_t, std::size_t) { return rho0; });
  body.set_each("volume", 1, [&](std::size_t, std::size_t) { return fine * fine; });
  set_masses(body);
  body.set_each("velocity", 2, [&](std::size_t i, std::size_t a) {
    return a == 0 ? std::pow(body["position"][2 * i + 1], 2) : 0.0;
  });
  body.set_each("acceleration", 2, [](std::size_t, std::size_t) { return 0.0; });
  CentralViscousForce op;
  op.viscosity = 3.0;
  op.reference_density = rho0;
  testing::run(op, body, {&body}, {.smoothing_length = wide, .spacing = fine});
  const std::size_t middle = 15 * 30 + 15;
  CHECK(body["acceleration"][2 * middle] == doctest::Approx(2.0 * 3.0 / rho0).epsilon(0.03));
  CHECK(body["acceleration"][2 * middle + 1] == doctest::Approx(0.0).scale(1e-3));
}

TEST_CASE("the walls' share of the central viscous force is that of fluid whose velocity they continue") {
  Body fluid(2, {0.0, 0.5 * dx}), wall(2, {0.0, -0.5 * dx, dx, -0.5 * dx, -dx, -1.5 * dx});
  fluid["velocity"] = {1.0, -2.0}, fluid["density"] = {rho0}, fluid["acceleration"] = {0.0, 0.0};
  wall["velocity"] = {0.5, 0, 0.5, 0, 0.5, 0};
  wall["normal"] = {0, 1, 0, 1, 0, 1};
  wall["signed_distance"] = {-0.5 * dx, -0.5 * dx, -1.5 * dx};
  wall["volume"] = {dx * dx, dx * dx, dx * dx};
  std::vector<double> force(2, 0.0);
  for_all_pairs(fluid, wall, 2 * h, [&](auto, auto j, double r, const auto& e) {
    const double factor = j < 2 ? 2.0 : 4.0;  // 1 + d_w / d_i
    const double v_r = factor * (0.5 * e[0] - 2.0 * e[1]) * r;
    for (std::size_t a = 0; a < 2; ++a)
      force[a] += 8.0 * 2.5 / rho0 * dx * dx * v_r / (r * r) * plain_dw(2, h, r) * e[a];
  });
  WallCentralViscousForce op;
  op.viscosity = 2.5;
  testing::run(op, fluid, {&wall}, {.smoothing_length = h, .spacing = dx, .cutoff = 2.0 * h});
  check_equal(fluid["acceleration"], force, 1e-12);
}

TEST_CASE("at a free surface particles are shifted along it only, inside in all directions, in spray not") {
  // A pool with a flat surface at its top, its particles disordered; sides and bottom are free as well, far away.
  auto positions = lattice(2, dx, {0, 0}, {3, 1.5}, 0.15);
  const std::size_t spray = positions.size() / 2;
  positions.insert(positions.end(), {1.5, 5.0});
  Body body(2, positions);
  body.set("volume", dx * dx);
  std::vector<double> shift(body.size() * 2, 0.0), filled(body.size(), 0.0);
  for_all_pairs(body, body, 2 * h, [&](auto i, auto, double r, const auto& e) {
    for (std::size_t a = 0; a < 2; ++a) shift[2 * i + a] -= 0.5 * h * h * dx * dx * plain_dw(2, h, r) * e[a];
    filled[i] -= 0.5 * dx * dx * r * plain_dw(2, h, r);
  });
  Crowding crowding;
  testing::run(crowding, body, {&body}, {.smoothing_length = h, .spacing = dx});
  check_equal(body["transport_shift"], shift, 1e-13);
  check_equal(body["filled"], filled, 1e-13);
  AlongSurface along;
  testing::run(along, body, {&body}, {.smoothing_length = h, .spacing = dx});
  std::size_t inside = 0, surface = 0;
  for (std::size_t i = 0; i < spray; ++i) {
    const double x = body["position"][2 * i], y = body["position"][2 * i + 1];
    if (x < 0.6 || x > 2.4) continue;
    if (y > 1.4) {
      ++surface;
      // Of the sum, which is 0.1 dx and more outward, nearly nothing is left across the surface.
      CHECK(shift[2 * i + 1] > 0.1 * dx);
      CHECK(std::abs(body["transport_shift"][2 * i + 1]) < 0.4 * shift[2 * i + 1]);
    } else if (y > 0.6 && y < 0.9) {
      ++inside;
      CHECK(body["transport_shift"][2 * i] == doctest::Approx(shift[2 * i]));
      CHECK(body["transport_shift"][2 * i + 1] == doctest::Approx(shift[2 * i + 1]));
    }
  }
  CHECK(surface > 10);
  CHECK(inside > 10);
  CHECK(body["transport_shift"][2 * spray] == 0.0);
}

TEST_CASE("the walls' share of crowding") {
  Body fluid(2, {0.0, 0.5 * dx}), wall(2, {0.0, -0.5 * dx, dx, -0.5 * dx});
  fluid["transport_shift"] = {0.01, 0.02}, fluid["filled"] = {0.3};
  wall["volume"] = {dx * dx, 2.0 * dx * dx};
  std::vector<double> expected = {0.01, 0.02, 0.3};
  for_all_pairs(fluid, wall, 2 * h, [&](auto, auto j, double r, const auto& e) {
    const double v = wall["volume"][j], dw = plain_dw(2, h, r);
    for (std::size_t a = 0; a < 2; ++a) expected[a] -= 0.5 * h * h * v * dw * e[a];
    expected[2] -= 0.5 * v * r * dw;
  });
  WallCrowding op;
  testing::run(op, fluid, {&wall}, {.smoothing_length = h, .spacing = dx, .cutoff = 2.0 * h});
  CHECK(fluid["transport_shift"][0] == doctest::Approx(expected[0]));
  CHECK(fluid["transport_shift"][1] == doctest::Approx(expected[1]));
  CHECK(fluid["filled"][0] == doctest::Approx(expected[2]));
}
