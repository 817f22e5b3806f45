// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The filter of velocities: against a least-squares fit in plain loops, and what it must leave alone.
#include "velocity_filter.hpp"

#include <doctest/doctest.h>

#include "particles.hpp"

using namespace shoal;
using namespace shoal::fluid;
using namespace shoal::fluid::test;

namespace {

constexpr double dx = 0.1, h = 1.3 * dx, rho0 = 1000.0;

Body water(int dimensions) {
  Body body(dimensions, dimensions == 2 ? lattice(2, dx, {0, 0}, {1, 1}, 0.25)
                                        : lattice(3, dx, {0, 0, 0}, {0.6, 0.6, 0.6}, 0.25));
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  body.set_each("velocity", static_cast<std::size_t>(dimensions),
                [&](auto, auto) { return uniform(random); });
  body.set_each("density", 1, [&](auto, auto) { return rho0 * (1.0 + 0.01 * uniform(random)); });
  auto& density = body["density"];
  body.set_each("volume", 1, [&](auto i, auto) { return rho0 * std::pow(dx, dimensions) / density[i]; });
  return body;
}

void filter(Body& body, double strength, bool scalar = false) {
  VelocityFluctuation fluctuation;
  testing::run(fluctuation, body, {&body}, {.smoothing_length = h, .scalar = scalar});
  VelocityFilter op;
  op.strength = strength;
  op.reference_density = rho0;
  testing::run(op, body, {&body}, {.smoothing_length = h, .scalar = scalar});
}

// Solves A x = b in place, by elimination with pivots; A in rows.
void solve(std::vector<std::vector<double>> a, std::vector<double>& b) {
  const std::size_t n = b.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t row = k; row < n; ++row)
      if (std::abs(a[row][k]) > std::abs(a[pivot][k])) pivot = row;
    std::swap(a[k], a[pivot]);
    std::swap(b[k], b[pivot]);
    for (std::size_t row = 0; row < n; ++row) {
      if (row == k) continue;
      const double factor = a[row][k] / a[k][k];
      for (std::size_t column = k; column < n; ++column) a[row][column] -= factor * a[k][column];
      b[row] -= factor * b[k];
    }
  }
  for (std::size_t k = 0; k < n; ++k) b[k] /= a[k][k];
}

// What a weighted linear fit over particle i and its neighbours leaves of the velocity of i.
std::vector<double> residuals(Body& body, int dimensions) {
  const auto d = static_cast<std::size_t>(dimensions), n = d + 1;
  std::vector<double> all;
  for (std::size_t i = 0; i < body.size(); ++i)
    for (std::size_t component = 0; component < d; ++component) {
      std::vector<std::vector<double>> normal(n, std::vector<double>(n, 0.0));
      std::vector<double> fit(n, 0.0);
      for (std::size_t j = 0; j < body.size(); ++j) {
        std::vector<double> terms(n, 1.0);
        double squared = 0;
        for (std::size_t a = 0; a < d; ++a) {
          terms[a + 1] = body["position"][j * d + a] - body["position"][i * d + a];
          squared += terms[a + 1] * terms[a + 1];
        }
        const double w = body["volume"][j] * plain_w(dimensions, h, std::sqrt(squared));
        for (std::size_t a = 0; a < n; ++a) {
          for (std::size_t b = 0; b < n; ++b) normal[a][b] += w * terms[a] * terms[b];
          fit[a] += w * terms[a] * body["velocity"][j * d + component];
        }
      }
      solve(normal, fit);
      all.push_back(body["velocity"][i * d + component] - fit[0]);
    }
  return all;
}

}  // namespace

TEST_CASE("the fluctuation is the residual of a linear fit, and the filter the plain sum over it") {
  for (const int dimensions : {2, 3})
    for (const bool scalar : {false, true}) {
      CAPTURE(dimensions);
      CAPTURE(scalar);
      const auto d = static_cast<std::size_t>(dimensions);
      Body body = water(dimensions);
      const std::vector<double> before = body["velocity"], residual = residuals(body, dimensions);
      std::vector<double> change(before.size(), 0.0);
      for_all_pairs(body, body, 2 * h, [&](auto i, auto j, double r, const auto& e) {
        double along = 0;
        for (std::size_t a = 0; a < d; ++a) along += (residual[i * d + a] - residual[j * d + a]) * e[a];
        for (std::size_t a = 0; a < d; ++a)
          change[i * d + a] += 0.3 * h * rho0 / body["density"][i] * body["volume"][j] * along * e[a] *
                               plain_dw(dimensions, h, r);
      });
      filter(body, 0.3, scalar);
      for (std::size_t k = 0; k < before.size(); ++k) {
        // The moments' regularisation is 1e-6 of h^2.
        REQUIRE(std::abs(body["velocity_fluctuation"][k] - residual[k]) < 1e-4);
        REQUIRE(std::abs(body["velocity"][k] - before[k] - change[k]) < 1e-4);
      }
    }
}

TEST_CASE("in single precision the filter does what it does in double") {
  for (const int dimensions : {2, 3}) {  // in 2D there is one form only
    Body body = water(dimensions), same = body;
    const std::vector<double> before = body["velocity"];
    filter(same, 0.3);
    VelocityFluctuation fluctuation;
    VelocityFilter op;
    fluctuation.single = op.single = std::make_shared<SinglePrecision>();
    op.strength = 0.3;
    op.reference_density = rho0;
    testing::run(fluctuation, body, {&body}, {.smoothing_length = h});
    testing::run(op, body, {&body}, {.smoothing_length = h});
    for (std::size_t k = 0; k < before.size(); ++k) {
      CHECK(std::abs(body["velocity_fluctuation"][k] - same["velocity_fluctuation"][k]) < 1e-5);
      CHECK(std::abs(body["velocity"][k] - same["velocity"][k]) < 1e-6);
    }
  }
}

TEST_CASE("linear flow passes the filter, at free surfaces too") {
  for (const int dimensions : {2, 3}) {
    const auto d = static_cast<std::size_t>(dimensions);
    Body body = water(dimensions);
    auto& x = body["position"];
    body.set_each("velocity", d, [&](auto i, auto a) {
      return 1.0 + static_cast<double>(a) + 2.0 * x[i * d] - (3.0 + static_cast<double>(a)) * x[i * d + 1];
    });
    const std::vector<double> before = body["velocity"];
    filter(body, 0.3);
    for (std::size_t k = 0; k < before.size(); ++k)
      REQUIRE(body["velocity"][k] == doctest::Approx(before[k]).epsilon(1e-5));
  }
}

TEST_CASE("the filter keeps momentum and angular momentum, and takes kinetic energy") {
  for (const int dimensions : {2, 3}) {
    const auto d = static_cast<std::size_t>(dimensions);
    Body body = water(dimensions);
    const auto totals = [&] {
      std::vector<double> sums(d + 2, 0.0);
      for (std::size_t i = 0; i < body.size(); ++i) {
        const double *v = &body["velocity"][i * d], *x = &body["position"][i * d];
        for (std::size_t a = 0; a < d; ++a) sums[a] += v[a], sums[d + 1] += 0.5 * v[a] * v[a];
        sums[d] += x[0] * v[1] - x[1] * v[0];
      }
      return sums;
    };
    for (int step = 0; step < 20; ++step) {
      const auto before = totals();
      filter(body, 0.8);
      const auto after = totals();
      for (std::size_t k = 0; k <= d; ++k)
        CHECK(after[k] == doctest::Approx(before[k]).epsilon(1e-12).scale(1.0));
      CHECK(after[d + 1] < before[d + 1]);
    }
  }
}
