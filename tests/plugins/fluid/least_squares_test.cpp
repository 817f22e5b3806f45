// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// fluid.least_squares: every sum over neighbours against a least-squares problem solved by QR for each particle, the
// stages of the viscous step against the exponential, the motion of particles against its formulas.
#include <doctest/doctest.h>

// gcc 12 warns of AVX-512 intrinsics that Eigen uses
#define EIGEN_DONT_VECTORIZE
#include <Eigen/Dense>

#include <cmath>

#include "least_squares/fit.hpp"
#include "least_squares/motion.hpp"
#include "least_squares/pressure.hpp"
#include "least_squares/stiffness.hpp"
#include "least_squares/viscosity.hpp"
#include "particles.hpp"

using namespace shoal;
using namespace shoal::fluid::least_squares;
using namespace shoal::fluid::test;

namespace {

constexpr double dx = 0.1, h = 1.3 * dx, rho0 = 900.0;

// All first and second derivatives of a field at particle i: the plain least-squares problem of its neighbours.
struct Derivatives {
  Eigen::VectorXd first;
  Eigen::MatrixXd second;
};
Derivatives derivatives(Body& body, std::size_t i, const std::vector<double>& f, std::size_t components = 1,
                        std::size_t component = 0) {
  const auto d = static_cast<std::size_t>(body.dimensions());
  const std::size_t n_terms = d + d * (d + 1) / 2;
  const auto& x = body["position"];
  std::vector<double> rows, values;
  for (std::size_t j = 0; j < body.size(); ++j) {
    double squared = 0;
    for (std::size_t a = 0; a < d; ++a) squared += std::pow(x[j * d + a] - x[i * d + a], 2);
    if (j == i || std::sqrt(squared) >= 2.0 * h) continue;
    const double root = std::sqrt(plain_w(body.dimensions(), h, std::sqrt(squared)));
    for (std::size_t a = 0; a < d; ++a) rows.push_back(root * (x[j * d + a] - x[i * d + a]));
    for (std::size_t a = 0; a < d; ++a)
      for (std::size_t b = a; b < d; ++b)
        rows.push_back(root * (a == b ? 0.5 : 1.0) * (x[j * d + a] - x[i * d + a]) *
                       (x[j * d + b] - x[i * d + b]));
    values.push_back(root * (f[j * components + component] - f[i * components + component]));
  }
  const auto n = static_cast<Eigen::Index>(values.size()), m = static_cast<Eigen::Index>(n_terms);
  const Eigen::Map<Eigen::Matrix<double, -1, -1, Eigen::RowMajor>> matrix(rows.data(), n, m);
  const Eigen::VectorXd c = matrix.colPivHouseholderQr().solve(Eigen::Map<Eigen::VectorXd>(values.data(), n));
  Derivatives result{c.head(static_cast<Eigen::Index>(d)), Eigen::MatrixXd(d, d)};
  Eigen::Index k = static_cast<Eigen::Index>(d);
  for (Eigen::Index a = 0; a < static_cast<Eigen::Index>(d); ++a)
    for (Eigen::Index b = a; b < static_cast<Eigen::Index>(d); ++b, ++k)
      result.second(a, b) = result.second(b, a) = c[k];
  return result;
}
double laplacian(Body& body, std::size_t i, const std::vector<double>& f, std::size_t components = 1,
                 std::size_t component = 0) {
  return derivatives(body, i, f, components, component).second.trace();
}

// sum_j l_ij r^4 / 64 in 2D, / 120 in 3D: the Laplacian at i of the field r^4 around i.
double bias(Body& body, std::size_t i) {
  const auto d = static_cast<std::size_t>(body.dimensions());
  std::vector<double> r4(body.size());
  for (std::size_t j = 0; j < body.size(); ++j) {
    double squared = 0;
    for (std::size_t a = 0; a < d; ++a)
      squared += std::pow(body["position"][j * d + a] - body["position"][i * d + a], 2);
    r4[j] = squared * squared;
  }
  return laplacian(body, i, r4) / (d == 2 ? 64.0 : 120.0);
}

// Disordered particles with fields that are no polynomials; surfaces on all sides, so fits are one-sided there.
Body disordered(int dimensions) {
  const std::vector<double> upper(static_cast<std::size_t>(dimensions), dimensions == 2 ? 1.0 : 0.6);
  Body body(dimensions, lattice(dimensions, dx, std::vector<double>(upper.size(), 0.0), upper, 0.2));
  const auto d = static_cast<std::size_t>(dimensions);
  const auto x = body["position"];
  const auto wavy = [&](std::size_t i, double k) {
    double phase = k;
    for (std::size_t a = 0; a < d; ++a) phase += (1.0 + 0.3 * static_cast<double>(a)) * k * x[i * d + a];
    return std::sin(phase);
  };
  double k = 2.0;
  for (const char* name :
       {"pressure", "pressure_mid", "pressure_wave", "pressure_source", "pressure_rate", "pressure_impulse"})
    body.set_each(name, 1, [&](std::size_t i, std::size_t) { return wavy(i, k); }), k += 0.3;
  for (const char* name : {"velocity", "carried_velocity", "velocity_mid", "viscous_velocity",
                           "viscous_acceleration", "specific_force", "acceleration", "pressure_gradient"})
    body.set_each(name, d, [&](std::size_t i, std::size_t c) { return wavy(i, k + static_cast<double>(c)); }),
        k += 0.3;
  body.set_each("shift", d, [&](std::size_t i, std::size_t c) {
    return 0.01 * dx * wavy(i, 9.0 + static_cast<double>(c));
  });
  body.set_each("velocity_gradient", d * d,
                [&](std::size_t i, std::size_t c) { return wavy(i, 2.0 + static_cast<double>(c)); });
  return body;
}

void solve(Body& body) {
  Fit fit;
  fit.course = std::make_shared<Course>();
  testing::run(fit, body, {&body}, {.smoothing_length = h, .spacing = dx});
}

template <class Check>
void in_all_ways(Check&& check) {
  for (const int dimensions : {2, 3})
    for (const bool scalar : {false, true}) {
      CAPTURE(dimensions);
      CAPTURE(scalar);
      check(dimensions, Setup{.smoothing_length = h, .spacing = dx, .dt = 0.01, .scalar = scalar});
    }
}

constexpr double rounding = 1e-9;  // QR against the inverse of moments whose condition number reaches 1e5
constexpr std::size_t every_fifth = 5;

}  // namespace

TEST_CASE("fields are carried along the shift with the gradients of the fit") {
  in_all_ways([](int dimensions, Setup setup) {
    Body body = disordered(dimensions), before = body;
    solve(body);
    Carry op;
    testing::run(op, body, {&body}, setup);
    const auto d = static_cast<std::size_t>(dimensions);
    for (std::size_t i = 0; i < body.size(); i += every_fifth) {
      const Derivatives dp = derivatives(body, i, before["pressure_mid"]);
      double carried = before["pressure"][i];
      for (std::size_t b = 0; b < d; ++b) {
        const double slope = dp.first[static_cast<Eigen::Index>(b)];
        CHECK(body["pressure_gradient"][i * d + b] == doctest::Approx(slope).epsilon(rounding).scale(10));
        carried += slope * body["shift"][i * d + b];
      }
      CHECK(body["pressure"][i] == doctest::Approx(carried).epsilon(rounding));
      for (std::size_t a = 0; a < d; ++a) {
        const Derivatives dv = derivatives(body, i, before["velocity_mid"], d, a);
        double moved = before["velocity"][i * d + a];
        for (std::size_t b = 0; b < d; ++b) {
          const double slope = dv.first[static_cast<Eigen::Index>(b)];
          CHECK(body["velocity_gradient"][(i * d + a) * d + b] ==
                doctest::Approx(slope).epsilon(rounding).scale(10));
          moved += slope * body["shift"][i * d + b];
        }
        CHECK(body["carried_velocity"][i * d + a] == doctest::Approx(moved).epsilon(rounding));
      }
    }
  });
}

TEST_CASE("the rate of a viscous stage, and the force without the Laplacian's leading error") {
  in_all_ways([](int dimensions, Setup setup) {
    Body body = disordered(dimensions);
    solve(body);
    ViscousRate rate;
    rate.viscosity = 0.3;
    rate.density = rho0;
    testing::run(rate, body, {&body}, setup);
    Body forced = body;
    ViscousForce force;
    testing::run(force, forced, {&forced}, setup);
    const auto d = static_cast<std::size_t>(dimensions);
    for (std::size_t i = 0; i < body.size(); i += every_fifth)
      for (std::size_t a = 0; a < d; ++a) {
        const std::size_t k = i * d + a;
        const double expected = 0.3 * laplacian(body, i, body["viscous_velocity"], d, a) +
                                body["acceleration"][k] - body["pressure_gradient"][k] / rho0;
        CHECK(body["viscous_rate"][k] == doctest::Approx(expected).epsilon(rounding).scale(100));
        const double corrected = body["acceleration"][k] + body["viscous_acceleration"][k] -
                                 bias(body, i) * laplacian(body, i, body["viscous_acceleration"], d, a);
        CHECK(forced["specific_force"][k] == doctest::Approx(corrected).epsilon(rounding).scale(100));
      }
  });
}

TEST_CASE("with its leading error taken off, the Laplacian is of fourth order on a lattice") {
  for (const int dimensions : {2, 3}) {
    const auto d = static_cast<std::size_t>(dimensions);
    const std::vector<double> upper(d, dimensions == 2 ? 1.5 : 1.1);
    Body body(dimensions, lattice(dimensions, dx, std::vector<double>(d, 0.0), upper));
    // A wave along the diagonal in the plane, where the lattice differs most from a medium without direction, and one
    // along an axis: on average over directions the error is that of the bi-Laplacian.
    double plain = 0, corrected = 0;
    const std::size_t middle = body.size() / 2;
    for (const double turn : {0.0, 1.0}) {
      const double k = 4.0;
      const auto wave = [&](std::size_t i) {
        const auto& x = body["position"];
        return std::cos(k * (x[i * d] + turn * x[i * d + 1]) / std::sqrt(1.0 + turn));
      };
      body.set_each("viscous_acceleration", d, [&](std::size_t i, std::size_t) { return wave(i); });
      solve(body);
      const double exact = -k * k * wave(middle);
      const double once = laplacian(body, middle, body["viscous_acceleration"], d, 0);
      // The operator takes the viscous acceleration for what it corrects: here the Laplacian of the wave.
      std::vector<double> first(body.size() * d, 0.0);
      for (std::size_t i = 0; i < body.size(); ++i) {
        double squared = 0;
        for (std::size_t a = 0; a < d; ++a)
          squared += std::pow(body["position"][i * d + a] - body["position"][middle * d + a], 2);
        if (squared < 4.0 * h * h) first[i * d] = laplacian(body, i, body["viscous_acceleration"], d, 0);
      }
      body["viscous_acceleration"] = first;
      ViscousForce op;
      testing::run(op, body, {&body}, {.smoothing_length = h, .spacing = dx});
      plain += (once - exact) / exact;
      corrected += (body["specific_force"][middle * d] - exact) / exact;
    }
    CHECK(std::abs(plain) > 0.01);
    CHECK(std::abs(corrected) < 0.12 * std::abs(plain));
  }
}

TEST_CASE("source, rate and force of the pressure") {
  in_all_ways([](int dimensions, Setup setup) {
    Body body = disordered(dimensions);
    solve(body);
    const auto course = std::make_shared<Course>();
    course->sound_speed = 7.0;
    const auto d = static_cast<std::size_t>(dimensions);
    Body sourced = body;
    WaveSource source;
    source.course = course;
    source.density = rho0;
    testing::run(source, sourced, {&sourced}, setup);
    CHECK(course->first_acoustic);
    Body kicked = body, kicked_again = body;
    WaveRate rate;
    rate.course = course;
    testing::run(rate, kicked, {&kicked}, setup);
    testing::run(rate, kicked_again, {&kicked_again}, setup);
    Body pressed = body;
    PressureForce force;
    force.density = rho0;
    testing::run(force, pressed, {&pressed}, setup);
    for (std::size_t i = 0; i < body.size(); i += every_fifth) {
      double div_v = 0, div_f = 0, s = 0;
      for (std::size_t a = 0; a < d; ++a) {
        const auto axis = static_cast<Eigen::Index>(a);
        div_v += derivatives(body, i, body["carried_velocity"], d, a).first[axis];
        div_f += derivatives(body, i, body["specific_force"], d, a).first[axis];
        for (std::size_t b = 0; b < d; ++b)
          s +=
              body["velocity_gradient"][(i * d + a) * d + b] * body["velocity_gradient"][(i * d + b) * d + a];
      }
      const double stiffness = rho0 * 49.0;
      CHECK(sourced["pressure_source"][i] ==
            doctest::Approx(-stiffness * (div_f - s)).epsilon(rounding).scale(stiffness));
      CHECK(sourced["pressure_rate"][i] ==
            doctest::Approx(-stiffness * (div_v + 0.005 * s)).epsilon(rounding).scale(stiffness));
      CHECK(sourced["pressure_wave"][i] == doctest::Approx(49.0 * body["pressure"][i]));
      CHECK(sourced["pressure_impulse"][i] == 0.0);
      const double second = laplacian(body, i, body["pressure_wave"]) + body["pressure_source"][i];
      CHECK(kicked["pressure_rate"][i] ==
            doctest::Approx(body["pressure_rate"][i] + 0.005 * second).epsilon(rounding).scale(10));
      CHECK(kicked_again["pressure_rate"][i] ==
            doctest::Approx(body["pressure_rate"][i] + 0.01 * second).epsilon(rounding).scale(10));
      const Derivatives impulse = derivatives(body, i, body["pressure_impulse"]);
      for (std::size_t a = 0; a < d; ++a)
        CHECK(pressed["pressure_acceleration"][i * d + a] ==
              doctest::Approx(-impulse.first[static_cast<Eigen::Index>(a)] / (rho0 * 0.01))
                  .epsilon(rounding)
                  .scale(1));
    }
  });
}

TEST_CASE("the stages decay like the exponential, to second order, and stay bounded to their limit") {
  // One mode, dw/dt = -lambda w + F, by the operator itself.
  const auto step = [](double number, int s, double limit) {  // towards w = limit
    Body body(2, {0.0, 0.0});
    const auto course = std::make_shared<Course>();
    course->dt = 0.5;
    course->viscous_stages = s;
    const double lambda = number / course->dt, force = lambda * limit;
    body["carried_velocity"] = {1.0, -2.0};
    body["viscous_velocity"] = {1.0, -2.0};
    body["acceleration"] = {force, force};
    body["pressure_gradient"] = {0.0, 0.0};
    ViscousStage op;
    op.course = course;
    op.density = rho0;
    for (int j = 1; j <= s; ++j) {
      CHECK(op.time_step(h) == 0.5 / s);
      body["viscous_rate"] = {force - lambda * body["viscous_velocity"][0],
                              force - lambda * body["viscous_velocity"][1]};
      testing::run(op, body, {}, {.smoothing_length = h});
    }
    CHECK(body["viscous_acceleration"][0] ==
          doctest::Approx((body["viscous_velocity"][0] - 1.0) / course->dt - force));
    return body["viscous_velocity"][0];
  };
  for (const int s : {3, 5, 9}) {
    CAPTURE(s);
    const auto error = [&](double number) {
      return std::abs(step(number, s, 3.0) - (3.0 - 2.0 * std::exp(-number)));
    };
    // Halved steps: the error of one step falls like its cube.
    CHECK(std::log2(error(0.02) / error(0.01)) == doctest::Approx(3.0).epsilon(0.02));
    const double limit = 0.5 * (s * s + s - 2);
    for (double number = 0.1; number <= limit; number += 0.1) CHECK(std::abs(step(number, s, 0.0)) <= 1.0);
    CHECK(std::abs(step(1.2 * limit, s, 0.0)) > 1.0);
    CHECK(Departure::stages(0.999 * limit) == s);
    CHECK(Departure::stages(1.001 * limit) == s + 2);
  }
}

TEST_CASE("the stiffness of the Laplacian is that of its stiffest wave on a lattice") {
  for (const int dimensions : {2, 3}) {
    const auto d = static_cast<std::size_t>(dimensions);
    const std::vector<double> upper(d, dimensions == 2 ? 0.9 : 0.7);
    Body body(dimensions, lattice(dimensions, dx, std::vector<double>(d, 0.0), upper));
    const std::size_t middle = body.size() / 2;
    double largest = 0;
    std::vector<double> wave(body.size());
    for (int a = 0; a <= 8; ++a)
      for (int b = 0; b <= 8; ++b)
        for (int c = 0; c <= (dimensions == 3 ? 8 : 0); ++c) {
          if (dimensions == 3 && (a + b + c) % 4 != 0) continue;  // a part of them, to save time
          for (std::size_t i = 0; i < body.size(); ++i) {
            const double k[] = {std::numbers::pi / 8 * a / dx, std::numbers::pi / 8 * b / dx,
                                std::numbers::pi / 8 * c / dx};
            double phase = 0;
            for (std::size_t m = 0; m < d; ++m)
              phase += k[m] * (body["position"][i * d + m] - body["position"][middle * d + m]);
            wave[i] = std::cos(phase);
          }
          largest = std::max(largest, -laplacian(body, middle, wave) * dx * dx);
        }
    // The wave along all diagonals is among those that were tried in 3D.
    CHECK(laplacian_stiffness(dimensions, 1.3) == doctest::Approx(1.3 * largest).epsilon(0.02));
  }
}

TEST_CASE("the bound on the rows of the Laplacian holds, and on a lattice is near") {
  for (const int dimensions : {2, 3})
    for (const bool ordered : {true, false}) {
      CAPTURE(dimensions);
      CAPTURE(ordered);
      const auto d = static_cast<std::size_t>(dimensions);
      const std::vector<double> upper(d, dimensions == 2 ? 0.9 : 0.7);
      Body body(dimensions, lattice(dimensions, dx, std::vector<double>(d, 0.0), upper, ordered ? 0.0 : 0.2));
      Fit fit;
      fit.course = std::make_shared<Course>();
      testing::run(fit, body, {&body}, {.smoothing_length = h, .spacing = dx});
      // The weight of particle j is the Laplacian of the field that is 1 there and 0 elsewhere.
      const auto row_sum = [&](std::size_t i) {
        double sum = 0;
        std::vector<double> one(body.size());
        for (std::size_t j = 0; j < body.size(); ++j) {
          if (j == i) continue;
          one[j] = 1.0;
          sum += std::abs(laplacian(body, i, one));
          one[j] = 0.0;
        }
        return sum;
      };
      const std::size_t middle = body.size() / 2;
      const double sum = row_sum(middle);
      CHECK(fit.course->laplacian_norm >= sum);
      if (ordered) continue;
      for (std::size_t i = 0; i < body.size(); i += 7) CHECK(fit.course->laplacian_norm >= row_sum(i));
    }
}

TEST_CASE("acoustic steps get shorter where the fit is stiffer than it is on a lattice") {
  WaveStep step;
  step.course = std::make_shared<Course>();
  step.course->sound_speed = 20.0;
  testing::Body one(2, {0.0, 0.0});
  for (const char* name : {"pressure_rate", "pressure", "pressure_impulse"})
    one.set_each(name, 1, [](auto, auto) { return 0.0; });
  testing::run(step, one, {}, {.smoothing_length = h, .spacing = dx, .dt = 0.01});
  step.eigenvalue_over_norm = eigenvalue_over_norm(2, 1.3);
  const double on_lattice = laplacian_stiffness(2, 1.3) / 1.3 / (dx * dx);  // the largest eigenvalue
  step.course->laplacian_norm = on_lattice / step.eigenvalue_over_norm;
  CHECK(step.time_step(h) == doctest::Approx(0.6 * h / 20.0));
  for (const double stiffer : {3.0, 10.0}) {
    step.course->laplacian_norm = stiffer * on_lattice / step.eigenvalue_over_norm;
    const double s = 20.0 * step.time_step(h);  // the way of sound in a step
    CHECK(stiffer * on_lattice * (s * s + 2.0 * step.damping * dx * s) == doctest::Approx(4.0 * 0.9));
  }
}

TEST_CASE("a step moves particles with the mean of the velocities and with the shift") {
  for (const int dimensions : {2, 3}) {
    Body body = disordered(dimensions);
    const auto d = static_cast<std::size_t>(dimensions);
    body.set_each("total_acceleration", d,
                  [](std::size_t i, std::size_t c) { return std::sin(double(i) + 2.0 * double(c)); });
    body.set_each("next_shift", d,
                  [](std::size_t i, std::size_t c) { return 0.01 * std::cos(double(i) + 2.0 * double(c)); });
    body.set_each("pressure_acceleration", d,
                  [](std::size_t i, std::size_t c) { return std::cos(3.0 * double(i) + double(c)); });
    const Body start = body;
    Body before = start;
    const double dt = 0.02;
    Departure departure;
    departure.course = std::make_shared<Course>();
    departure.least_speed = 0.05;
    departure.mach = 0.05;
    departure.viscosity = 0.01;
    departure.stiffness = 4.0;
    testing::run(departure, body, {}, {.smoothing_length = h, .spacing = dx, .dt = dt});
    double fastest = 0;
    for (std::size_t i = 0; i < body.size(); ++i) {
      double squared = 0;
      for (std::size_t a = 0; a < d; ++a) {
        const std::size_t k = i * d + a;
        squared += std::pow(before["velocity"][k], 2);
        double v = before["velocity"][k] + 0.5 * dt * before["total_acceleration"][k];
        for (std::size_t b = 0; b < d; ++b)
          v += 0.5 * before["velocity_gradient"][k * d + b] * before["shift"][i * d + b];
        CHECK(body["velocity_mid"][k] == doctest::Approx(v));
      }
      fastest = std::max(fastest, std::sqrt(squared));
    }
    CHECK(departure.course->sound_speed == doctest::Approx(fastest / 0.05));
    CHECK(departure.course->viscous_stages == 3);
    Arrival arrival;
    testing::run(arrival, body, {}, {.smoothing_length = h, .spacing = dx, .dt = dt});
    for (std::size_t k = 0; k < body.size() * d; ++k) {
      const double a = before["specific_force"][k] + before["pressure_acceleration"][k];
      const double v = before["carried_velocity"][k] + dt * a;
      CHECK(body["velocity"][k] == doctest::Approx(v));
      CHECK(
          body["position"][k] ==
          doctest::Approx(before["position"][k] + 0.5 * dt * (before["velocity"][k] + v) + before["shift"][k])
              .epsilon(1e-12));
      CHECK(body["shift"][k] == before["next_shift"][k]);
    }
  }
}

TEST_CASE("particles that crowd are pushed apart, no further than a tenth of their spacing") {
  Body body(2, lattice(2, dx, {0, 0}, {1, 1}));
  auto& x = body["position"];
  const std::size_t crowded = 5 * 10 + 5;
  x[2 * crowded] += 0.4 * dx;
  solve(body);
  CHECK(body["next_shift"][2 * crowded] < -0.02 * dx);
  for (std::size_t i = 0; i < body.size(); ++i)
    CHECK(std::hypot(body["next_shift"][2 * i], body["next_shift"][2 * i + 1]) <= 0.1 * dx * (1 + 1e-12));
  // Particles on the lattice far from it stay.
  CHECK(std::abs(body["next_shift"][2 * 33]) < 1e-12);
}
