// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// fluid.least_squares at walls: what walls continue of the fluid's fields, against polynomials that must come out exactly,
// and the distance that particles keep.
#include <doctest/doctest.h>

#include <cmath>

#include "least_squares/clearance.hpp"
#include "least_squares/surface_motion.hpp"
#include "least_squares/walls.hpp"
#include "particles.hpp"

using namespace shoal;
using namespace shoal::fluid::least_squares;
using namespace shoal::fluid::test;

namespace {

constexpr double dx = 0.1, h = 1.3 * dx, rho0 = 900.0;

// Fluid above a wall whose surface is the plane through (0, ..., 0) with a normal that is slanted in the plane.
struct Shore {
  Body water, wall;
  std::vector<double> normal;
};
Shore shore(int dimensions) {
  const auto d = static_cast<std::size_t>(dimensions);
  const double half = 0.4;
  std::vector<double> n(d, 0.0);
  n[0] = -0.28, n[1] = 0.96;
  const auto all = lattice(dimensions, dx, std::vector<double>(d, -half), std::vector<double>(d, half), 0.15);
  std::vector<double> wet, dry, depth;
  for (std::size_t i = 0; i < all.size() / d; ++i) {
    double distance = 0;
    for (std::size_t a = 0; a < d; ++a) distance += n[a] * all[i * d + a];
    auto& side = distance > 0 ? wet : dry;
    side.insert(side.end(), all.begin() + static_cast<std::ptrdiff_t>(i * d),
                all.begin() + static_cast<std::ptrdiff_t>(i * d + d));
    if (distance <= 0) depth.push_back(distance);
  }
  Shore shore{Body(dimensions, wet), Body(dimensions, dry), n};
  shore.wall["signed_distance"] = depth;
  shore.wall.set_each("normal", d, [&](std::size_t, std::size_t a) { return n[a]; });
  return shore;
}

// As in a run: neighbours of walls are looked for up to 4h, while fits reach to 2h.
template <class Op>
void run_at_wall(Op&& op, Shore& s, bool scalar) {
  testing::run(op, s.wall, {&s.water},
               {.smoothing_length = h, .spacing = dx, .scalar = scalar, .cutoff = 4.0 * h});
}

}  // namespace

TEST_CASE(
    "walls continue quadratic fields exactly: velocity from its value at the surface, pressure from its "
    "slope") {
  for (const int dimensions : {2, 3})
    for (const bool scalar : {false, true}) {
      CAPTURE(dimensions);
      CAPTURE(scalar);
      Shore s = shore(dimensions);
      const auto d = static_cast<std::size_t>(dimensions);
      const auto above = [&](Body& body, std::size_t i) {
        double distance = 0;
        for (std::size_t a = 0; a < d; ++a) distance += s.normal[a] * body["position"][i * d + a];
        return distance;
      };
      const auto along = [&](Body& body, std::size_t i) {
        return s.normal[1] * body["position"][i * d] - s.normal[0] * body["position"][i * d + 1];
      };
      // v = v_w + 3 y - 5 y^2 + 2 x y for the distance y from the wall, x along it: v_w at the surface.
      const auto velocity = [&](Body& body, std::size_t i, std::size_t a) {
        const double y = above(body, i), x = along(body, i);
        return (a == 0 ? 0.7 : -0.2) + 3.0 * y - 5.0 * y * y + 2.0 * x * y;
      };
      // dp/dn = rho n.f at the surface, f uniform.
      const double slope = rho0 * (s.normal[0] * 0.3 + s.normal[1] * -9.0);
      const auto pressure = [&](Body& body, std::size_t i) {
        const double y = above(body, i), x = along(body, i);
        return 5000.0 + slope * y + 800.0 * x + 3000.0 * x * x - 2000.0 * y * y;
      };
      s.water.set_each("velocity_mid", d,
                       [&](std::size_t i, std::size_t a) { return velocity(s.water, i, a); });
      s.water.set_each("pressure_mid", 1, [&](std::size_t i, std::size_t) { return pressure(s.water, i); });
      s.water.set_each("specific_force", d, [&](std::size_t, std::size_t a) {
        return a == 0 ? 0.3 : a == 1 ? -9.0 : 0.0;
      });
      s.water["carried_velocity"] = s.water["velocity_mid"];
      s.wall.set_each("surface_velocity", d, [](std::size_t, std::size_t a) { return a == 0 ? 0.7 : -0.2; });
      s.wall.set_each("surface_acceleration", d, [](std::size_t, std::size_t) { return 0.0; });
      run_at_wall(WallSurface{}, s, scalar);
      run_at_wall(WallFit{}, s, scalar);
      const auto course = std::make_shared<Course>();
      course->dt = 0.01;
      WallVelocity<MidVelocity> velocities;
      velocities.course = course;
      run_at_wall(velocities, s, scalar);
      run_at_wall(WallForceField<SpecificForce>{}, s, scalar);
      s.wall.set_each("wall_normal_force", 1, [&](std::size_t, std::size_t) { return slope / rho0; });
      WallPressure<MidPressure> op;
      op.course = course;
      op.density = rho0;
      run_at_wall(op, s, scalar);
      std::size_t tested = 0;
      for (std::size_t i = 0; i < s.wall.size(); ++i) {
        double sideways = 0;  // deeper or further out, rows that amplify noise become linear
        for (std::size_t a = 0; a < d; ++a)
          sideways =
              std::max(sideways, std::abs(s.wall["position"][i * d + a] - above(s.wall, i) * s.normal[a]));
        if (above(s.wall, i) < -0.7 * dx || sideways > 0.15) continue;
        ++tested;
        for (std::size_t a = 0; a < d; ++a) {
          CHECK(s.wall["velocity_mid"][i * d + a] ==
                doctest::Approx(velocity(s.wall, i, a)).epsilon(1e-8).scale(1));
          CHECK(s.wall["specific_force"][i * d + a] == doctest::Approx(a == 0   ? 0.3
                                                                       : a == 1 ? -9.0
                                                                                : 0.0)
                                                           .scale(1));
        }
        // The condition on the slope is an equation among others, if one with a large weight.
        CHECK(s.wall["pressure_mid"][i] == doctest::Approx(pressure(s.wall, i)).epsilon(1e-3));
      }
      CHECK(tested > 1);
    }
}

TEST_CASE(
    "where no fluid is at the surface a wall takes the fluid's mean pressure and keeps its own velocity") {
  Body wall(2, {0.0, 0.0}), water(2, {0.5 * dx, 1.2 * dx, -0.5 * dx, 1.2 * dx, 0.1 * dx, 1.5 * dx});
  wall["normal"] = {1.0, 0.0};
  wall["signed_distance"] = {-4.0 * dx};  // a surface far from the fluid
  wall["surface_velocity"] = {3.0, 4.0};
  wall["surface_acceleration"] = {0.0, 0.0};
  wall["wall_normal_force"] = {5.0};
  water["pressure_mid"] = {7.0, 7.0, 7.0};
  water["velocity_mid"] = {1, 1, 1, 1, 1, 1};
  Shore s{water, wall, {1.0, 0.0}};
  run_at_wall(WallSurface{}, s, false);
  run_at_wall(WallFit{}, s, false);
  WallVelocity<MidVelocity> velocity;
  velocity.course = std::make_shared<Course>();
  run_at_wall(velocity, s, false);
  WallPressure<MidPressure> op;
  op.course = velocity.course;
  op.density = rho0;
  run_at_wall(op, s, false);
  CHECK(s.wall["velocity_mid"][0] == 3.0);
  CHECK(s.wall["velocity_mid"][1] == 4.0);
  CHECK(s.wall["pressure_mid"][0] == doctest::Approx(7.0));
}

TEST_CASE("a free-slip wall takes the fluid along as it is, and its normal velocity as no-slip walls do") {
  for (const int dimensions : {2, 3})
    for (const bool scalar : {false, true}) {
      CAPTURE(dimensions);
      CAPTURE(scalar);
      Shore s = shore(dimensions);
      const auto d = static_cast<std::size_t>(dimensions);
      // Along the wall 2 + x - 3 y^2, whose slope across it is zero at the surface; across it 0.4 + 5 y, 0.4 being the
      // wall's at that time: velocity 0.3, and 1/10 s after the midpoint with an acceleration of 1.
      const auto velocity = [&](Body& body, std::size_t i, std::size_t a) {
        double y = 0;
        for (std::size_t b = 0; b < d; ++b) y += s.normal[b] * body["position"][i * d + b];
        const double x = s.normal[1] * body["position"][i * d] - s.normal[0] * body["position"][i * d + 1];
        const double tangent = a == 0 ? s.normal[1] : a == 1 ? -s.normal[0] : 0.0;
        return (2.0 + x - 3.0 * y * y) * tangent + (0.4 + 5.0 * y) * s.normal[a];
      };
      s.water.set_each("carried_velocity", d,
                       [&](std::size_t i, std::size_t a) { return velocity(s.water, i, a); });
      s.wall.set_each("surface_velocity", d, [&](std::size_t, std::size_t a) { return 0.5 * s.normal[a]; });
      s.wall.set_each("surface_acceleration", d, [&](std::size_t, std::size_t a) { return s.normal[a]; });
      run_at_wall(WallSurface{}, s, scalar);
      run_at_wall(WallFit{}, s, scalar);
      FreeSlipWallVelocity<CarriedVelocity> op;  // of the beginning of the step
      op.course = std::make_shared<Course>();
      op.course->dt = 0.2;
      run_at_wall(op, s, scalar);
      std::size_t tested = 0;
      for (std::size_t i = 0; i < s.wall.size(); ++i) {
        double y = 0, sideways = 0;
        for (std::size_t a = 0; a < d; ++a) y += s.normal[a] * s.wall["position"][i * d + a];
        for (std::size_t a = 0; a < d; ++a)
          sideways = std::max(sideways, std::abs(s.wall["position"][i * d + a] - y * s.normal[a]));
        if (y < -0.7 * dx || sideways > 0.15) continue;
        ++tested;
        for (std::size_t a = 0; a < d; ++a)
          CHECK(s.wall["carried_velocity"][i * d + a] ==
                doctest::Approx(velocity(s.wall, i, a)).epsilon(1e-3).scale(1));
      }
      CHECK(tested > 1);
    }
}

TEST_CASE(
    "the slope of the pressure at a wall balances forces, the wall's acceleration, and flow through it") {
  Shore s = shore(2);
  s.water.set_each("carried_velocity", 2, [&](std::size_t i, std::size_t a) {
    return 0.5 * s.normal[a] + 0.3 * s.water["position"][2 * i];  // linear, so that its fit is exact
  });
  s.wall.set_each("surface_velocity", 2, [](std::size_t, std::size_t a) { return a == 0 ? 0.2 : 0.1; });
  s.wall.set_each("surface_acceleration", 2, [](std::size_t, std::size_t a) { return a == 0 ? 3.0 : -1.0; });
  s.wall.set_each("specific_force", 2, [](std::size_t, std::size_t a) { return a == 0 ? 0.5 : -9.0; });
  run_at_wall(WallSurface{}, s, false);
  run_at_wall(WallFit{}, s, false);
  WallNormalForce op;
  op.course = std::make_shared<Course>();
  op.course->dt = 0.04;
  run_at_wall(op, s, false);
  std::size_t tested = 0;
  // The condition is evaluated where the fit of forces is linear, away from the ends of this short wall.
  for (std::size_t i = 0; i < s.wall.size(); ++i) {
    const double *x = &s.wall["position"][2 * i], *n = s.normal.data();
    const double y = n[0] * x[0] + n[1] * x[1], foot = x[0] - y * n[0];
    if (y < -0.7 * dx || std::abs(foot) > 0.15) continue;
    ++tested;
    // The velocity of the wall at the beginning of the step is half a step before the midpoint.
    double expected = 0;
    const double force[] = {0.5, -9.0}, wall[] = {0.2, 0.1}, acceleration[] = {3.0, -1.0};
    for (int a = 0; a < 2; ++a)
      expected += n[a] * (force[a] - acceleration[a] +
                          0.25 * (0.5 * n[a] + 0.3 * foot - (wall[a] - 0.02 * acceleration[a])) / 0.04);
    CHECK(s.wall["wall_normal_force"][i] == doctest::Approx(expected).epsilon(1e-9));
  }
  CHECK(tested > 1);
}

TEST_CASE("a wall that turns has the velocity and the centripetal acceleration of its surface") {
  for (const int dimensions : {2, 3})
    for (const bool scalar : {false, true}) {
      Body wall(dimensions,
                lattice(dimensions, dx, std::vector<double>(static_cast<std::size_t>(dimensions), 0.3),
                        std::vector<double>(static_cast<std::size_t>(dimensions), 0.8), 0.2));
      const auto d = static_cast<std::size_t>(dimensions);
      const double omega = 3.0;
      wall.set_each("velocity", d, [&](std::size_t i, std::size_t a) {
        const double* x = &wall["position"][i * d];
        return a == 0 ? -omega * x[1] : a == 1 ? omega * x[0] : 0.0;
      });
      wall.set_each("normal", d, [](std::size_t, std::size_t a) {
        return a == 0 ? 0.6 : a == 1 ? 0.8 : 0.0;
      });
      wall.set_each("signed_distance", 1, [](std::size_t i, std::size_t) { return -0.01 * double(i % 9); });
      SurfaceMotion op;
      testing::run(op, wall, {&wall}, {.smoothing_length = h, .spacing = dx, .scalar = scalar});
      for (std::size_t i = 0; i < wall.size(); ++i) {
        const double *x = &wall["position"][i * d], s = wall["signed_distance"][i];
        const double on[] = {x[0] - 0.6 * s, x[1] - 0.8 * s};
        CHECK(wall["surface_velocity"][i * d] == doctest::Approx(-omega * on[1]).epsilon(1e-6));
        CHECK(wall["surface_velocity"][i * d + 1] == doctest::Approx(omega * on[0]).epsilon(1e-6));
        CHECK(wall["surface_acceleration"][i * d] == doctest::Approx(-omega * omega * on[0]).epsilon(1e-6));
        CHECK(wall["surface_acceleration"][i * d + 1] ==
              doctest::Approx(-omega * omega * on[1]).epsilon(1e-6));
      }
    }
}

namespace {

// Particles at `x` near the corner between a floor that slides and a side wall at rest; v, and what they are shifted by.
std::vector<double> cleared(const std::vector<double>& x, const std::vector<double>& v, bool scalar) {
  std::vector<double> wall_x, normal, distance, velocity;
  for (int k = -3; k < 12; ++k)
    for (int m = -3; m < 12; ++m) {
      if (k >= 0 && m >= 0) continue;
      const double at[] = {(k + 0.5) * dx, (m + 0.5) * dx};
      wall_x.insert(wall_x.end(), at, at + 2);
      const bool floor = m < 0;
      normal.insert(normal.end(), {floor ? 0.0 : 1.0, floor ? 1.0 : 0.0});
      distance.push_back(floor ? at[1] : at[0]);
      velocity.insert(velocity.end(), {floor ? 2.0 : 0.0, 0.0});
    }
  Body fluid(2, x), wall(2, wall_x);
  wall["normal"] = normal, wall["signed_distance"] = distance, wall["velocity"] = velocity;
  fluid["velocity_mid"] = v;
  fluid["shift"] = fluid["next_shift"] = std::vector<double>(x.size(), 0.0);
  Clearance op;
  testing::run(op, fluid, {&wall},
               {.smoothing_length = h, .spacing = dx, .dt = 0.02, .scalar = scalar, .cutoff = 2.0 * h});
  return fluid["next_shift"];
}

}  // namespace

TEST_CASE("particles that would come too near to a wall are shifted away from it, and others are not") {
  for (const bool scalar : {false, true}) {
    CAPTURE(scalar);
    // Far from walls; along the floor with it; at rest at half a spacing; away from the side wall
    for (const double shift :
         cleared({0.5, 0.5, 0.5, 0.05, 0.05, 0.05, 0.031, 0.5}, {-1, -1, 2, 0, 0, 0, 1, 0}, scalar))
      CHECK(shift == 0.0);
    // Onto the floor: after 3/2 steps it would be at 0.035 - 0.015 = 0.02, less than 0.03
    const std::vector<double> down = cleared({0.5, 0.035}, {2.0, -0.5}, scalar);
    CHECK(down[0] == doctest::Approx(0.0).scale(1));
    CHECK(down[1] == doctest::Approx(0.01).epsilon(0.2));
    // Into the corner: both walls are heeded.
    const std::vector<double> corner = cleared({0.035, 0.035}, {-0.5, -0.5}, scalar);
    CHECK(corner[0] == doctest::Approx(0.01).epsilon(0.3));
    CHECK(corner[1] == doctest::Approx(0.01).epsilon(0.3));
    // Never further than a quarter of the spacing
    CHECK(cleared({0.5, -0.02}, {0, -4}, scalar)[1] == doctest::Approx(0.25 * dx));
  }
}
