// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Pressure force and divergence against the formulas of the paper in plain double loops, their conservation laws,
// and walls: a fluid at rest next to a wall must feel what it would feel inside the fluid.
#include "riemann.hpp"

#include <doctest/doctest.h>

#include "lattice.hpp"
#include "particles.hpp"
#include "shoal/freeze_geometry.hpp"
#include "wall.hpp"

using namespace shoal;
using namespace shoal::fluid;
using namespace shoal::fluid::test;

namespace {

constexpr double rho0 = 1000.0, c = 12.0;

Body disordered(int dimensions, double dx) {
  Body body(dimensions, dimensions == 2 ? lattice(2, dx, {0, 0}, {1, 1}, 0.25)
                                        : lattice(3, dx, {0, 0, 0}, {0.6, 0.6, 0.6}, 0.25));
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto d = static_cast<std::size_t>(dimensions);
  body.set_each("velocity", d, [&](auto, auto) { return uniform(random); });
  body.set_each("pressure", 1, [&](auto, auto) { return 500.0 * uniform(random); });
  body.set_each("density", 1, [&](auto, auto) { return rho0 * (1.0 + 0.01 * uniform(random)); });
  body.set_each("last_pressure_acceleration", d, [&](auto, auto) { return 5.0 * uniform(random); });
  const double mass = rho0 * std::pow(dx, dimensions);
  auto& density = body["density"];
  body.set_each("volume", 1, [&](auto i, auto) { return mass / density[i]; });
  set_masses(body);
  return body;
}

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

void check_equal(const std::vector<double>& got, const std::vector<double>& wanted, double relative) {
  REQUIRE(got.size() == wanted.size());
  const double scale = largest(wanted);
  REQUIRE(scale > 0);
  for (std::size_t k = 0; k < got.size(); ++k) {
    CAPTURE(k);
    REQUIRE(std::abs(got[k] - wanted[k]) <= relative * scale);
  }
}

// Runs an operator with the geometry of the middle of a step that begins with the body as it is.
template <class Op>
void run_frozen(Op& op, Body& body, double h, double step) {
  op.single = std::make_shared<SinglePrecision>();
  FreezeGeometry freeze;
  freeze.single = op.single;
  testing::run(freeze, body, {&body}, {.smoothing_length = h, .dt = step});
  testing::run(op, body, {&body}, {.smoothing_length = h});
}

// The body half a step on.
Body halfway(Body body, double step) {
  auto &x = body["position"], &v = body["velocity"];
  for (std::size_t k = 0; k < x.size(); ++k) x[k] += 0.5 * step * v[k];
  return body;
}

}  // namespace

TEST_CASE(
    "with frozen geometry both passes give what they do in the middle of the step, in single precision") {
  const double dx = 0.1, h = 1.3 * dx;
  for (const double step : {0.0, 0.25 * h / c, 0.02}) {  // the last: neighbours come and go, at the edge of W
    CAPTURE(step);
    Body body = disordered(2, dx), middle = halfway(body, step);
    PressureForce fresh, frozen;
    fresh.reference_density = frozen.reference_density = rho0;
    fresh.sound_speed = frozen.sound_speed = c;
    testing::run(fresh, middle, {&middle}, {.smoothing_length = h});
    run_frozen(frozen, body, h, step);
    const double tolerance = step == 0.02 ? 2e-3 : 1e-6;
    check_equal(body["pressure_acceleration"], middle["pressure_acceleration"], tolerance);
    check_equal(body["density_diffusion"], middle["density_diffusion"], tolerance);

    VelocityDivergence now, then;
    now.reference_density = then.reference_density = rho0;
    now.sound_speed = then.sound_speed = c;
    testing::run(now, middle, {&middle}, {.smoothing_length = h});
    run_frozen(then, body, h, step);
    check_equal(body["pressure_acceleration"], middle["pressure_acceleration"], tolerance);
    check_equal(body["compression_rate"], middle["compression_rate"], tolerance);
  }
}

TEST_CASE("in single precision both passes give what they do in double in 3D too") {
  const double dx = 0.1, h = 1.3 * dx;
  Body body = disordered(3, dx), same = body;
  PressureForce force, force_in_double;
  VelocityDivergence divergence, divergence_in_double;
  force.single = divergence.single = std::make_shared<SinglePrecision>();
  const auto compare = [&](auto& op, auto& reference, const char* rate) {
    op.reference_density = reference.reference_density = rho0;
    op.sound_speed = reference.sound_speed = c;
    testing::run(op, body, {&body}, {.smoothing_length = h});
    testing::run(reference, same, {&same}, {.smoothing_length = h});
    check_equal(body["pressure_acceleration"], same["pressure_acceleration"], 1e-6);
    check_equal(body[rate], same[rate], 1e-6);
  };
  compare(force, force_in_double, "density_diffusion");
  compare(divergence, divergence_in_double, "compression_rate");
}

TEST_CASE("in single precision walls do what they do in double, also when they have moved") {
  const double dx = 0.1, h = 1.3 * dx;
  Body water = disordered(3, dx);
  water.set_each("acceleration", 3, [](auto, auto a) { return a == 2 ? -9.81 : 0.0; });
  for (const char* field : {"pressure_acceleration", "compression_rate"})
    water.set_each(field, field[0] == 'p' ? 3 : 1, [](auto, auto) { return 0.0; });
  Body same = water;
  Body wall(3, lattice(3, dx, {0, 0, -0.3}, {0.6, 0.6, 0}));
  wall.set("volume", dx * dx * dx);
  wall.set_each("normal", 3, [](auto, auto a) { return a == 2 ? 1.0 : 0.0; });
  wall.set_each("velocity", 3, [](auto, auto a) { return a == 2 ? 0.3 : -0.2; });
  wall.set_each("signed_distance", 1, [&](std::size_t i, auto) { return wall["position"][3 * i + 2]; });
  WallPressureForce force, force_in_double;
  WallVelocityDivergence divergence, divergence_in_double;
  force.single = std::make_shared<SinglePrecision>();
  divergence.single = std::make_shared<SinglePrecision>();
  for (const double lift : {0.0, 0.02}) {
    for (std::size_t i = 0; i < wall.size(); ++i) wall["position"][3 * i + 2] += lift;
    force.reference_density = force_in_double.reference_density = rho0;
    divergence.sound_speed = divergence_in_double.sound_speed = c;
    testing::run(force, water, {&wall}, {.smoothing_length = h});
    testing::run(force_in_double, same, {&wall}, {.smoothing_length = h});
    check_equal(water["pressure_acceleration"], same["pressure_acceleration"], 1e-6);
    testing::run(divergence, water, {&wall}, {.smoothing_length = h});
    testing::run(divergence_in_double, same, {&wall}, {.smoothing_length = h});
    check_equal(water["pressure_acceleration"], same["pressure_acceleration"], 1e-6);
    check_equal(water["compression_rate"], same["compression_rate"], 1e-6);
  }
}

TEST_CASE("in single precision momentum is conserved to its rounding") {
  const double dx = 0.1, h = 1.3 * dx;
  for (const int dimensions : {2, 3}) {
    CAPTURE(dimensions);
    Body body = disordered(dimensions, dx);
    const auto d = static_cast<std::size_t>(dimensions);
    PressureForce op;
    op.reference_density = rho0;
    op.sound_speed = c;
    body.set_each("pressure_acceleration", d, [](auto, auto) { return 0.0; });
    if (dimensions == 2) {
      run_frozen(op, body, h, 0.25 * h / c);
    } else {
      op.single = std::make_shared<SinglePrecision>();
      testing::run(op, body, {&body}, {.smoothing_length = h});
    }
    double total[3] = {}, size = 0;
    for (std::size_t i = 0; i < body.size(); ++i)
      for (std::size_t a = 0; a < d; ++a) {
        const double force = body["mass"][i] * body["pressure_acceleration"][d * i + a];
        total[a] += force;
        size += std::abs(force);
      }
    // Sums of a particle are rounded to 6e-8 of their terms, in whatever order the compiler takes these; in all the errors
    // cancel but for a part.
    for (const double sum : total) CHECK(std::abs(sum) < 3e-8 * size);
  }
}

TEST_CASE("pressure force and its dissipation equal the paper's sums") {
  for (const int dimensions : {2, 3})
    for (const bool scalar : {false, true}) {
      CAPTURE(dimensions);
      CAPTURE(scalar);
      const double dx = 0.1, h = 1.3 * dx;
      const auto d = static_cast<std::size_t>(dimensions);
      Body body = disordered(dimensions, dx);
      std::vector<double> force(body.size() * d, 0.0), rate(body.size(), 0.0);
      for_all_pairs(body, body, 2 * h, [&](auto i, auto j, double r, const auto& e) {
        const double v = body["volume"][j], dw = plain_dw(dimensions, h, r);
        const double mean = 0.5 * (body["pressure"][i] + body["pressure"][j]);
        double smooth = 0;
        for (std::size_t a = 0; a < d; ++a) {
          force[i * d + a] -= 2.0 / body["density"][i] * v * mean * dw * e[a];
          smooth -=
              0.5 * rho0 * r * e[a] *
              (body["last_pressure_acceleration"][i * d + a] + body["last_pressure_acceleration"][j * d + a]);
        }
        const double jump = body["pressure"][i] - body["pressure"][j];
        if (jump * smooth > 0)
          rate[i] -= v * std::copysign(std::min(std::abs(jump), std::abs(smooth)), jump) / c * dw;
        rate[i] += v * jump / c * dw;
      });

      PressureForce op;
      op.reference_density = rho0;
      op.sound_speed = c;
      testing::run(op, body, {&body}, {.smoothing_length = h, .scalar = scalar});
      check_equal(body["pressure_acceleration"], force, 1e-13);
      check_equal(body["density_diffusion"], rate, 1e-13);
    }
}

TEST_CASE("divergence and its dissipation equal the paper's sums") {
  for (const int dimensions : {2, 3})
    for (const bool scalar : {false, true}) {
      CAPTURE(dimensions);
      CAPTURE(scalar);
      const double dx = 0.1, h = 1.3 * dx;
      const auto d = static_cast<std::size_t>(dimensions);
      Body body = disordered(dimensions, dx);
      std::vector<double> force(body.size() * d, 0.0), rate(body.size(), 0.0);
      for_all_pairs(body, body, 2 * h, [&](auto i, auto j, double r, const auto& e) {
        const double v = body["volume"][j], dw = plain_dw(dimensions, h, r);
        double approach = 0;
        for (std::size_t a = 0; a < d; ++a)
          approach -= (body["velocity"][i * d + a] - body["velocity"][j * d + a]) * e[a];
        const double beta = std::min(3.0 * std::max(approach, 0.0) / c, 1.0);
        for (std::size_t a = 0; a < d; ++a)
          force[i * d + a] -= rho0 / body["density"][i] * v * c * beta * approach * dw * e[a];
        rate[i] -= body["density"][i] * v * approach * dw;
      });

      VelocityDivergence op;
      op.reference_density = rho0;
      op.sound_speed = c;
      testing::run(op, body, {&body}, {.smoothing_length = h, .scalar = scalar});
      check_equal(body["pressure_acceleration"], force, 1e-13);
      check_equal(body["compression_rate"], rate, 1e-13);
    }
}

TEST_CASE("pressure conserves momentum and angular momentum to rounding") {
  for (const int dimensions : {2, 3}) {
    const double dx = 0.1, h = 1.3 * dx;
    const auto d = static_cast<std::size_t>(dimensions);
    Body body = disordered(dimensions, dx);
    PressureForce op;
    op.reference_density = rho0;
    op.sound_speed = c;
    testing::run(op, body, {&body}, {.smoothing_length = h});
    std::vector<double> total(d, 0.0);
    double torque = 0, size = 0;
    for (std::size_t i = 0; i < body.size(); ++i) {
      const double m = body["mass"][i];
      const double* a = &body["pressure_acceleration"][i * d];
      const double* x = &body["position"][i * d];
      for (std::size_t k = 0; k < d; ++k) total[k] += m * a[k], size += std::abs(m * a[k]);
      torque += m * (x[0] * a[1] - x[1] * a[0]);
    }
    for (const double sum : total) CHECK(std::abs(sum) < 1e-13 * size);
    CHECK(std::abs(torque) < 1e-13 * size);
  }
}

namespace {

// Water in a corner of two walls, at rest under gravity: the exact hydrostatic pressure on a lattice.
struct Corner {
  double dx = 0.05, h = 1.3 * 0.05, g = 9.81, depth = 1.0;
  Body water, walls, ocean;

  // `ocean` is the water with the walls' particles turned into water: what the water should feel.
  Corner() : water(2, lattice(2, dx, {0, 0}, {1, 1})), walls(2, wall_points()), ocean(2, ocean_points()) {
    for (Body* body : {&water, &walls, &ocean}) {
      body->set("volume", dx * dx);
      body->set_each("velocity", 2, [](auto, auto) { return 0.0; });
    }
    for (Body* body : {&water, &ocean}) {
      body->set("density", rho0);
      set_masses(*body);
      body->set_each("acceleration", 2, [&](auto, auto a) { return a == 1 ? -g : 0.0; });
      body->set_each("last_pressure_acceleration", 2, [&](auto, auto a) { return a == 1 ? g : 0.0; });
      auto& x = (*body)["position"];
      body->set_each("pressure", 1, [&](auto i, auto) { return rho0 * g * (depth - x[2 * i + 1]); });
    }
    auto& x = walls["position"];
    walls.set_each("normal", 2, [&](auto i, auto a) {
      const bool floor = x[2 * i + 1] < x[2 * i];
      return floor == (a == 1) ? 1.0 : 0.0;
    });
    walls.set_each("signed_distance", 1, [&](auto i, auto) { return std::min(x[2 * i], x[2 * i + 1]); });
  }
  std::vector<double> wall_points() const {
    std::vector<double> points = lattice(2, dx, {-0.2, -0.2}, {1, 0});
    for (const double x : lattice(2, dx, {-0.2, 0}, {0, 1})) points.push_back(x);
    return points;
  }
  std::vector<double> ocean_points() const {
    std::vector<double> points = lattice(2, dx, {0, 0}, {1, 1});
    for (const double x : wall_points()) points.push_back(x);
    return points;
  }
  // Away from the outer sides of the block, which have no walls.
  bool supported(std::size_t i) const { return water_x(i, 0) < 1 - 2 * h && water_x(i, 1) < 1 - 2 * h; }
  double water_x(std::size_t i, std::size_t a) const {
    return const_cast<Corner*>(this)->water["position"][2 * i + a];
  }
};

}  // namespace

TEST_CASE("water at rest feels walls, corners too, as it would feel more water") {
  Corner corner;
  PressureForce inner;
  inner.reference_density = rho0;
  inner.sound_speed = c;
  Target target;
  target.smoothing_length = corner.h;
  target.spacing = corner.dx;
  WallPressureForce wall;
  wall.reference_density = rho0;
  inner.gradient_scale = wall.gradient_scale = 1.0 / lattice_sums(2, target).slope;
  testing::run(inner, corner.water, {&corner.water}, {.smoothing_length = corner.h});
  testing::run(wall, corner.water, {&corner.walls}, {.smoothing_length = corner.h});
  testing::run(inner, corner.ocean, {&corner.ocean}, {.smoothing_length = corner.h});
  for (std::size_t i = 0; i < corner.water.size(); ++i) {
    if (!corner.supported(i)) continue;
    CAPTURE(i);
    CHECK(corner.water["pressure_acceleration"][2 * i] == doctest::Approx(0.0).epsilon(1).scale(1e-9));
    CHECK(corner.water["pressure_acceleration"][2 * i + 1] ==
          doctest::Approx(corner.ocean["pressure_acceleration"][2 * i + 1]).epsilon(1e-10));
    CHECK(corner.water["pressure_acceleration"][2 * i + 1] == doctest::Approx(corner.g).epsilon(1e-10));
    CHECK(std::abs(corner.water["density_diffusion"][i]) < 1e-9 * rho0);
  }
}

TEST_CASE("a wall does not pull") {
  Body drop(2, {0.0, 0.02});
  drop.set("density", rho0);
  drop.set("pressure", 1.0);
  drop.set_each("acceleration", 2, [](auto, auto a) { return a == 1 ? 50.0 : 0.0; });  // away from the wall
  Body wall(2, lattice(2, 0.05, {-0.3, -0.3}, {0.3, 0.0}));
  wall.set("volume", 0.05 * 0.05);
  WallPressureForce op;
  op.reference_density = rho0;
  testing::run(op, drop, {&wall}, {.smoothing_length = 0.065});
  CHECK(drop["pressure_acceleration"][1] > 0.0);
}

TEST_CASE("a wall does not pull a particle in tension that touches it, where there is a free surface") {
  const double dx = 0.05;
  Body wall(2, lattice(2, dx, {-0.3, -0.3}, {0.3, 0.0}));
  wall.set("volume", dx * dx);
  wall.set_each("normal", 2, [](auto, auto a) { return a == 1 ? 1.0 : 0.0; });
  wall.set_each("signed_distance", 1, [&](std::size_t i, auto) { return wall["position"][2 * i + 1]; });
  wall.set_each("velocity", 2, [](auto, auto) { return 0.0; });
  for (const double height : {0.2 * dx, 0.3 * dx})
    for (const bool free_surface : {true, false}) {
      CAPTURE(height);
      CAPTURE(free_surface);
      Body drop(2, {0.0, height});
      drop.set("density", rho0);
      drop.set("volume", dx * dx);
      drop.set("pressure", -1000.0);
      drop.set_each("velocity", 2, [](auto, auto) { return 0.0; });
      drop.set_each("acceleration", 2, [](auto, auto) { return 0.0; });
      WallPressureForce op;
      op.reference_density = rho0;
      WallForce force;
      force.reference_density = rho0;
      force.sound_speed = c;
      if (free_surface) op.touching = force.touching = 0.25 * dx;
      testing::run(op, drop, {&wall}, {.smoothing_length = 1.3 * dx});
      testing::run(force, wall, {&drop}, {.smoothing_length = 1.3 * dx});
      const double pull = drop["pressure_acceleration"][1];
      if (free_surface && height < 0.25 * dx)
        CHECK(pull == 0.0);
      else
        CHECK(pull < -1.0);
      double on_wall = 0;
      for (std::size_t j = 0; j < wall.size(); ++j) on_wall += wall["force"][2 * j + 1];
      CHECK(on_wall == doctest::Approx(-rho0 * dx * dx * pull));
    }
}

TEST_CASE("the force on a wall is the opposite of what the wall does to the fluid") {
  Corner corner;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  corner.water.set_each("velocity", 2, [&](auto, auto) { return uniform(random); });
  const double eta = 5.0, mass = rho0 * corner.dx * corner.dx;

  WallPressureForce pressure;
  pressure.reference_density = rho0;
  WallVelocityDivergence impact;
  impact.sound_speed = c;
  WallViscousForce viscous;
  viscous.viscosity = eta;
  corner.water.set_each("compression_rate", 1, [](auto, auto) { return 0.0; });
  testing::run(impact, corner.water, {&corner.walls}, {.smoothing_length = corner.h});
  testing::run(pressure, corner.water, {&corner.walls}, {.smoothing_length = corner.h});
  auto gravity = corner.water["acceleration"];
  corner.water.set_each("acceleration", 2, [](auto, auto) { return 0.0; });
  testing::run(viscous, corner.water, {&corner.walls}, {.smoothing_length = corner.h});
  std::vector<double> on_fluid(2, 0.0);
  for (std::size_t i = 0; i < corner.water.size(); ++i)
    for (std::size_t a = 0; a < 2; ++a)
      on_fluid[a] +=
          mass * (corner.water["pressure_acceleration"][2 * i + a] + corner.water["acceleration"][2 * i + a]);

  corner.water["acceleration"] = gravity;
  WallForce force;
  force.reference_density = rho0;
  force.sound_speed = c;
  force.viscosity = eta;
  testing::run(force, corner.walls, {&corner.water}, {.smoothing_length = corner.h});
  std::vector<double> on_wall(2, 0.0);
  for (std::size_t j = 0; j < corner.walls.size(); ++j)
    for (std::size_t a = 0; a < 2; ++a) on_wall[a] += corner.walls["force"][2 * j + a];
  for (std::size_t a = 0; a < 2; ++a) {
    CHECK(std::abs(on_fluid[a]) > 100.0);
    CHECK(on_wall[a] == doctest::Approx(-on_fluid[a]).epsilon(1e-12));
  }
}
