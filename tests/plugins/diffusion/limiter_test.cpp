// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The limiter of the monotone scheme, against its formulas written out in plain loops, and what it promises: largest values
// do not grow, smallest ones do not shrink, contents stay.
#include "limiter.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "fit.hpp"
#include "particles.hpp"

using namespace shoal;
using namespace shoal::diffusion;
using namespace shoal::diffusion::test;

namespace {

constexpr int side = 16;
constexpr double dx = 0.1, h = 1.3 * dx, fixed = 0.7;
const testing::Setup setup{.smoothing_length = h, .spacing = dx};

// A square with fibres at 30 degrees, ratio 1000; the value is given where x = 0 if `has_value`.
struct Square {
  Body body;
  std::shared_ptr<Stencil> stencil = std::make_shared<Stencil>();
  testing::impl::Rows list;

  explicit Square(double jitter, bool has_value = false) : body(2, lattice(2, dx, side, jitter)) {
    const double c = std::cos(std::numbers::pi / 6), s = 0.5, across = 1e-3;
    const double K[4] = {across + (1 - across) * c * c, (1 - across) * c * s, (1 - across) * c * s,
                         across + (1 - across) * s * s};
    list = testing::impl::all_pairs(body, body, 2.0 * h);
    body.set("volume", dx * dx);
    body.set_each("c_conductivity", 4, [&](std::size_t, std::size_t ab) { return K[ab]; });
    stencil->motions.push_back(std::make_shared<Motion>());
    stencil->seen = {7};
    stencil->limited = true;
    FitWeights weights;
    weights.monotone = true;
    weights.set("c", false, stencil);
    if (has_value) give_value(weights);
    testing::run(weights, body, {&body}, setup);
  }
  void give_value(FitWeights& weights) {
    body.set_each("surface_normal", 2, [](std::size_t, std::size_t a) { return a == 0 ? -1.0 : 0.0; });
    body.set_each("signed_distance", 1, [&](std::size_t i, std::size_t) { return -body["position"][2 * i]; });
    body.set_each("c_surface", 1,
                  [&](std::size_t i, std::size_t) { return body["position"][2 * i] < dx ? 2.0 : 0.0; });
    body.set("c_surface_data", fixed);
    std::vector<Condition> value(1);
    value[0].a = 1, value[0].b = 0;
    weights.set_surface("c", value);
  }
  void limit(bool has_value = false) {
    LimiterBounds bounds;
    bounds.set("c", stencil, has_value);
    testing::run(bounds, body, {&body}, setup);
    ApplyLimited apply;
    apply.set("c", stencil, has_value);
    body.set("c_rate", 0.0);
    testing::run(apply, body, {&body}, setup);
  }
  template <class Value>
  void set_values(Value&& value) {
    body.set_each("c", 1, [&](std::size_t i, std::size_t) {
      return value(body["position"][2 * i], body["position"][2 * i + 1]);
    });
  }
  // Calls work(j, l, a) for the neighbours of i, whose weights stand in the order of the lists.
  template <class Work>
  void for_neighbours(std::size_t i, Work&& work) {
    for (std::size_t m = 0; m < list.counts[i]; ++m) {
      const std::size_t entry = list.offsets[i] + m;
      work(list.indices[entry], stencil->weights[0][entry], stencil->more[0][entry]);
    }
  }
};

// Steep, with plateaus, a peak and noise.
double rough(double x, double y) {
  const double block = std::abs(x - 0.8) < 0.35 && std::abs(y - 0.7) < 0.25 ? 1.0 : 0.0;
  return block + (x > 1.2 ? 0.3 * std::sin(40 * x * y) : 0.0);
}

// The formulas of limiter.hpp for all particles, without surfaces.
std::vector<double> plain_rates(Square& square) {
  std::vector<double>& c = square.body["c"];
  std::vector<double> rise, fall, rates;
  for (std::size_t i = 0; i < c.size(); ++i) {
    double L = 0, k = 0, up = 0, down = 0, highest = c[i], lowest = c[i];
    square.for_neighbours(i, [&](std::uint32_t j, double l, double a) {
      L += l * (c[j] - c[i]);
      k += 2.5 * l;
      up += std::max(0.0, a * (c[j] - c[i]));
      down += std::min(0.0, a * (c[j] - c[i]));
      highest = std::max(highest, c[j]);
      lowest = std::min(lowest, c[j]);
    });
    rise.push_back(up > 0 ? std::min(1.0, std::max(0.0, k * (highest - c[i]) - L) / up) : 1.0);
    fall.push_back(down < 0 ? std::min(1.0, std::max(0.0, L - k * (lowest - c[i])) / -down) : 1.0);
  }
  for (std::size_t i = 0; i < c.size(); ++i) {
    double rate = 0;
    square.for_neighbours(i, [&](std::uint32_t j, double l, double a) {
      const double f = a * (c[j] - c[i]);
      rate += l * (c[j] - c[i]) + f * (f > 0 ? std::min(rise[i], fall[j]) : std::min(fall[i], rise[j]));
    });
    rates.push_back(rate);
  }
  return rates;
}

}  // namespace

TEST_CASE("the limiter is that of its formulas, on a lattice and on disordered particles") {
  for (const double jitter : {0.0, 0.15}) {
    Square square(jitter);
    square.set_values(rough);
    square.limit();
    const std::vector<double> expected = plain_rates(square);
    double scale = 0, limited = 0;
    for (const double rate : expected) scale = std::max(scale, std::abs(rate));
    for (std::size_t i = 0; i < expected.size(); ++i) {
      CHECK(std::abs(square.body["c_rate"][i] - expected[i]) < 1e-12 * scale);
      limited += square.body["c_rise"][i] < 1.0 || square.body["c_fall"][i] < 1.0 ? 1.0 : 0.0;
    }
    CHECK(limited > 10);
  }
}

TEST_CASE("limited rates raise no largest value and lower no smallest one, also at given surfaces") {
  for (const bool has_value : {false, true}) {
    Square square(0.15, has_value);
    square.set_values(rough);
    square.limit(has_value);
    const std::vector<double>& c = square.body["c"];
    int extrema = 0, broken_by_accurate = 0;
    for (std::size_t i = 0; i < c.size(); ++i) {
      if (has_value && square.body["position"][2 * i] < 2.0 * h) continue;  // the surface may be the extremum
      double highest = c[i], lowest = c[i], accurate = 0;
      square.for_neighbours(i, [&](std::uint32_t j, double l, double a) {
        accurate += (l + a) * (c[j] - c[i]);
        highest = std::max(highest, c[j]);
        lowest = std::min(lowest, c[j]);
      });
      const double rate = square.body["c_rate"][i];
      if (c[i] == highest) CHECK(rate <= 1e-10);
      if (c[i] == lowest) CHECK(rate >= -1e-10);
      extrema += c[i] == highest || c[i] == lowest;
      broken_by_accurate += (c[i] == highest && accurate > 1e-6) || (c[i] == lowest && accurate < -1e-6);
    }
    CHECK(extrema > 10);
    CHECK(broken_by_accurate > 3);  // else there would be nothing to show
    // At the surface, c and the data bound the rate.
    if (has_value)
      for (std::size_t i = 0; i < c.size(); ++i) {
        if (square.body["position"][2 * i] > dx) continue;
        double highest = std::max(c[i], fixed);
        square.for_neighbours(i, [&](std::uint32_t j, double, double) { highest = std::max(highest, c[j]); });
        if (c[i] == highest) CHECK(square.body["c_rate"][i] <= 1e-10);
      }
  }
}

TEST_CASE("inside a lattice pairs exchange what they give, and a linear field stays as it is") {
  Square square(0.0);
  square.set_values(
      [&](double x, double y) { return std::abs(x - 0.8) + std::abs(y - 0.8) < 0.25 ? 1.0 : 0.0; });
  square.limit();
  double content = 0, size = 0;
  for (const double rate : square.body["c_rate"]) content += rate, size += std::abs(rate);
  CHECK(std::abs(content) < 1e-9 * size);

  square.set_values([](double x, double y) { return 1.0 + 0.3 * x + 0.2 * y; });
  square.limit();
  for (std::size_t i = 0; i < square.body.size(); ++i) {
    const double x = square.body["position"][2 * i], y = square.body["position"][2 * i + 1];
    if (std::min({x, y, 1.6 - x, 1.6 - y}) > 4.0 * h) CHECK(std::abs(square.body["c_rate"][i]) < 1e-4);
  }
}
