// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Zones of open boundaries against plain loops: extrapolation, who joins and who leaves, prescribed motion.
#include <doctest/doctest.h>

#include <bit>
#include <cmath>

#include "open_boundary/outflow.hpp"
#include "particles.hpp"

using namespace shoal;
using namespace shoal::fluid;
using namespace shoal::fluid::test;

namespace {

constexpr double dx = 0.05, h = 1.3 * dx, rho0 = 1000.0, c = 20.0;

const shoal_equation_of_state linear{sizeof(shoal_equation_of_state),
                                     0,
                                     [](void*) { return rho0; },
                                     [](void*) { return 0.0; },
                                     [](void*, double) { return c; },
                                     [](void*, std::uint64_t n, const double* rho, double* p) {
                                       for (std::uint64_t i = 0; i < n; ++i) p[i] = c * c * (rho[i] - rho0);
                                     },
                                     [](void*, std::uint64_t n, const double* p, double* rho) {
                                       for (std::uint64_t i = 0; i < n; ++i) rho[i] = rho0 + p[i] / (c * c);
                                     }};
const EquationOfState equation_of_state{&linear, nullptr};

// A plane at 30 degrees to the axes through (0.4, 0.5); the fluid is on the upper right.
ZonePointer oblique(double length) {
  auto zone = std::make_shared<Zone>();
  zone->name = 42;
  zone->origin = {0.4, 0.5, 0.0};
  zone->normal = {std::sqrt(0.75), 0.5, 0.0};
  zone->lower = {-1e9, -1e9, -1e9};
  zone->upper = {1e9, 1e9, 1e9};
  zone->length = length;
  return zone;
}

double distance(const Zone& zone, const Body& body, std::size_t i) {
  const auto& x = const_cast<Body&>(body)["position"];
  return (x[2 * i] - zone.origin[0]) * zone.normal[0] + (x[2 * i + 1] - zone.origin[1]) * zone.normal[1];
}

void set_names(Body& body, const Zone& zone) {
  body.set_each("open_boundary", 1, [&](std::size_t i, std::size_t) {
    const double s = distance(zone, body, i);
    return std::bit_cast<double>(s < 0.0 && s >= -zone.length ? zone.name : std::int64_t{0});
  });
}
std::int64_t name_of(Body& body, std::size_t i) {
  return std::bit_cast<std::int64_t>(body["open_boundary"][i]);
}

Body disordered() {
  Body body(2, lattice(2, dx, {0, 0}, {1, 1}, 0.2));
  body.set("volume", dx * dx);
  body.set("mass", rho0 * dx * dx);
  body.set("density", rho0);
  return body;
}

template <class Op>
void run(Op& op, Body& body, double dt = 0.0) {
  Setup setup;
  setup.smoothing_length = h;
  setup.spacing = dx;
  setup.dt = dt;
  shoal::testing::run(op, body, {&body}, setup);
}

}  // namespace

TEST_CASE(
    "pressure in a zone: exact where it is linear, the plain sum where it is not, kept where no fluid is "
    "near") {
  const ZonePointer zone = oblique(0.3);
  for (const bool is_linear : {true, false}) {
    Body body = disordered();
    set_names(body, *zone);
    const auto position = body["position"];
    const auto p_of = [&](std::size_t i) {
      return 300.0 - 700.0 * position[2 * i] + 200.0 * position[2 * i + 1] +
             (is_linear ? 0.0 : 50.0 * std::sin(20.0 * position[2 * i]));
    };
    body.set_each("pressure", 1,
                  [&](std::size_t i, std::size_t) { return name_of(body, i) != 0 ? 12345.0 : p_of(i); });
    body.set_each("last_pressure_acceleration", 2,
                  [](std::size_t, std::size_t a) { return a == 0 ? 0.7 : -0.2; });
    const auto before = body["pressure"];
    ZonePressure op;
    op.zone = zone;
    op.equation_of_state = equation_of_state;
    run(op, body);
    int kept = 0, filled = 0;
    for (std::size_t i = 0; i < body.size(); ++i) {
      const double p = body["pressure"][i];
      if (name_of(body, i) == 0) {
        CHECK(p == before[i]);
        continue;
      }
      double sum = 0, weight = 0;
      for (std::size_t j = 0; j < body.size(); ++j) {
        if (j == i || name_of(body, j) != 0) continue;
        const double x = position[2 * i] - position[2 * j], y = position[2 * i + 1] - position[2 * j + 1];
        const double w = dx * dx * plain_w(2, h, std::hypot(x, y));
        weight += w;
        sum += w * (p_of(j) - rho0 * (0.7 * x - 0.2 * y));
      }
      if (weight > 0.0) {
        ++filled;
        CHECK(p == doctest::Approx(is_linear ? p_of(i) : sum / weight).epsilon(1e-10));
      } else {
        ++kept;
        CHECK(p == 12345.0);
      }
      CHECK(body["density"][i] == doctest::Approx(rho0 + p / (c * c)));
      CHECK(body["volume"][i] == doctest::Approx(rho0 * dx * dx / body["density"][i]));
    }
    CHECK(kept > 20);
    CHECK(filled > 20);
  }
}

TEST_CASE(
    "velocity behind an outlet: that of the fluid before it, never inward, and the place that belongs to "
    "it") {
  const ZonePointer zone = oblique(0.3);
  Body body = disordered();
  set_names(body, *zone);
  const auto position = body["position"];
  const double dt = 0.01;
  body.set_each("velocity", 2, [&](std::size_t i, std::size_t a) {
    return a == 0 ? -1.0 + 2.0 * position[2 * i + 1] : 0.3 * std::sin(9.0 * position[2 * i]);
  });
  body.set_each("acceleration", 2, [](std::size_t, std::size_t a) { return a == 0 ? 0.5 : -9.0; });
  body.set_each("last_pressure_acceleration", 2,
                [](std::size_t, std::size_t a) { return a == 0 ? 3.0 : 9.0; });
  Body before = body;
  auto impedance = std::make_shared<Impedance>();
  impedance->time = 0.5;
  OutflowVelocity op;
  op.zone = zone;
  op.impedance = impedance;
  run(op, body, dt);
  const double n[2] = {zone->normal[0], zone->normal[1]};
  double flux = 0, weights = 0;
  int inward = 0, alone = 0;
  for (std::size_t i = 0; i < body.size(); ++i) {
    double v[2] = {before["velocity"][2 * i], before["velocity"][2 * i + 1]};
    if (name_of(body, i) != 0) {
      double sum[2] = {0, 0}, weight = 0;
      for (std::size_t j = 0; j < body.size(); ++j) {
        if (j == i || name_of(body, j) != 0) continue;
        const double w =
            dx * dx *
            plain_w(2, h,
                    std::hypot(position[2 * i] - position[2 * j], position[2 * i + 1] - position[2 * j + 1]));
        weight += w;
        for (std::size_t a = 0; a < 2; ++a) sum[a] += w * before["velocity"][2 * j + a];
      }
      alone += weight > 0.0 ? 0 : 1;
      v[0] = weight > 0.0 ? sum[0] / weight : v[0] - dt * 3.5;
      v[1] = weight > 0.0 ? sum[1] / weight : v[1];
      const double along = v[0] * n[0] + v[1] * n[1];
      flux -= weight * along;
      weights += weight;
      inward += along > 0.0 ? 1 : 0;
      for (std::size_t a = 0; a < 2; ++a) v[a] -= std::max(0.0, along) * n[a];
    }
    for (std::size_t a = 0; a < 2; ++a) {
      CHECK(body["velocity"][2 * i + a] == doctest::Approx(v[a]).epsilon(1e-10));
      const double moved = 0.5 * dt * (v[a] - before["velocity"][2 * i + a]);
      CHECK(body["position"][2 * i + a] == doctest::Approx(position[2 * i + a] + moved).epsilon(1e-12));
    }
  }
  CHECK(inward > 5);
  CHECK(alone > 20);
  CHECK(impedance->mean == doctest::Approx(flux / weights));
  CHECK(impedance->excess == doctest::Approx(0.0));
}

TEST_CASE("the pressure of a non-reflecting outlet is that of a wave that passes") {
  const ZonePointer zone = oblique(0.3);
  Body body = disordered();
  set_names(body, *zone);
  auto impedance = std::make_shared<Impedance>();
  impedance->time = 0.5;
  impedance->excess = 0.02;
  struct Constant {
    static shoal_status evaluate(const shoal_expression*, int32_t, std::uint64_t n, const double*, double,
                                 double* out) {
      for (std::uint64_t k = 0; k < n; ++k) out[k] = 70.0;
      return SHOAL_OK;
    }
  };
  shoal_host host{};
  host.size = sizeof host;
  host.evaluate = &Constant::evaluate;
  shoal::impl::host_table = &host;
  OutflowState op;
  op.zone = zone;
  op.equation_of_state = equation_of_state;
  op.impedance = impedance;
  run(op, body);
  for (std::size_t i = 0; i < body.size(); ++i)
    CHECK(body["pressure"][i] == doctest::Approx(name_of(body, i) != 0 ? 70.0 + rho0 * c * 0.02 : 0.0));
  shoal::impl::host_table = nullptr;
}

TEST_CASE("who joins and who leaves at an inlet") {
  const ZonePointer zone = oblique(0.3);
  Body body(2, lattice(2, dx, {-0.4, -0.4}, {1, 1}, 0.2));
  body.set_each("mass", 1, [](std::size_t i, std::size_t) { return 1.0 + 0.01 * static_cast<double>(i); });
  set_names(body, *zone);
  // The zone has moved on by 0.06: some of it has crossed the plane.
  for (std::size_t i = 0; i < body.size(); ++i)
    if (name_of(body, i) != 0)
      for (std::size_t a = 0; a < 2; ++a) body["position"][2 * i + a] += 0.06 * zone->normal[a];
  std::vector<std::uint64_t> crossed, driven_out;
  double mass = 0;
  for (std::size_t i = 0; i < body.size(); ++i) {
    const double s = distance(*zone, body, i);
    if (name_of(body, i) != 0 && s >= 0.0) crossed.push_back(i), mass += body["mass"][i];
    if (name_of(body, i) == 0 && s < -0.3 && s > -0.6) driven_out.push_back(i), mass -= body["mass"][i];
  }
  Inflow op;
  op.zone = zone;
  op.crossed = std::make_shared<double>(0.0);
  run(op, body);
  Exchange exchange;
  op.exchange(exchange);
  shoal_exchange asked{};
  exchange.to_c(asked);
  REQUIRE(crossed.size() > 5);
  REQUIRE(driven_out.size() > 5);
  CHECK(std::vector<std::uint64_t>(asked.sources, asked.sources + asked.n_joining) == crossed);
  CHECK(std::vector<std::uint64_t>(asked.leaving, asked.leaving + asked.n_leaving) == driven_out);
  CHECK(*op.crossed == doctest::Approx(mass));
  for (const std::uint64_t i : crossed) CHECK(name_of(body, i) == 0);
  // As if these were the copies
  const auto before = body["position"];
  op.fill(10, 20);
  for (std::size_t i = 0; i < body.size(); ++i)
    for (std::size_t a = 0; a < 2; ++a)
      CHECK(body["position"][2 * i + a] ==
            doctest::Approx(before[2 * i + a] - (i >= 10 && i < 20 ? 0.3 * zone->normal[a] : 0.0)));
  for (std::size_t i = 10; i < 20; ++i) CHECK(name_of(body, i) == 42);
}

TEST_CASE("who leaves at an outlet, and what has left") {
  const ZonePointer zone = oblique(0.3);
  Body body(2, lattice(2, dx, {-0.4, -0.4}, {1, 1}, 0.2));
  body.set("mass", 2.0);
  set_names(body, *zone);
  for (std::size_t i = 0; i < body.size(); ++i)
    for (std::size_t a = 0; a < 2; ++a)
      body["position"][2 * i + a] -= (i % 5 == 0 ? -0.06 : 0.06) * zone->normal[a];
  double left = 0;
  std::vector<std::uint64_t> gone;
  std::vector<std::int64_t> names;
  for (std::size_t i = 0; i < body.size(); ++i) {
    const double s = distance(*zone, body, i);
    const bool was_in = name_of(body, i) != 0;
    if (!was_in && s < 0.0) left += 2.0;
    if (was_in && s >= 0.0) left -= 2.0;
    if (s < -0.3) gone.push_back(i);
    names.push_back(s < 0.0 ? 42 : 0);
  }
  Outflow op;
  op.zone = zone;
  op.crossed = std::make_shared<double>(0.0);
  run(op, body);
  Exchange exchange;
  op.exchange(exchange);
  shoal_exchange asked{};
  exchange.to_c(asked);
  REQUIRE(gone.size() > 5);
  CHECK(std::vector<std::uint64_t>(asked.leaving, asked.leaving + asked.n_leaving) == gone);
  CHECK(asked.n_joining == 0);
  CHECK(*op.crossed == doctest::Approx(left));
  for (std::size_t i = 0; i < body.size(); ++i) CHECK(name_of(body, i) == names[i]);
}
