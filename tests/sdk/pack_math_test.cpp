// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Exponentials and logarithms of packs and numbers against the C library's in long double.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "shoal/pack_math.hpp"

namespace {

using shoal::lanes;
using shoal::Pack;

// Difference in units in the last place of the exact value.
double ulps(double got, long double exact) {
  const double rounded = static_cast<double>(exact);
  if (got == rounded) return 0.0;
  const double unit =
      std::nextafter(std::fabs(rounded), std::numeric_limits<double>::infinity()) - std::fabs(rounded);
  return static_cast<double>(std::fabs(static_cast<long double>(got) - exact) /
                             static_cast<long double>(unit));
}

// The largest error over random arguments, of packs and of numbers.
template <class Draw, class Function, class Exact>
double largest_error(Draw draw, Function function, Exact exact) {
  std::mt19937_64 random(11);
  double worst = 0;
  for (int trial = 0; trial < 100000; ++trial) {
    double x[lanes];
    for (double& lane : x) lane = draw(random);
    const Pack y = function(Pack::load(x));
    for (int k = 0; k < lanes; ++k)
      worst = std::max(worst, ulps(y[k], exact(static_cast<long double>(x[k]))));
    worst = std::max(worst, ulps(function(x[0]), exact(static_cast<long double>(x[0]))));
  }
  return worst;
}

auto uniform(double low, double high) {
  return [=](auto& random) { return std::uniform_real_distribution<double>(low, high)(random); };
}
auto magnitude(double low, double high) {  // all magnitudes alike
  return [=](auto& random) { return std::exp(std::uniform_real_distribution<double>(low, high)(random)); };
}

const double inf = std::numeric_limits<double>::infinity();
const double not_a_number = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("fast_exp is within 2 ulp over its whole range") {
  const auto f = [](auto x) { return shoal::fast_exp(x); };
  const auto exact = [](long double x) { return std::exp(x); };
  CHECK(largest_error(uniform(-706.9, 709.7), f, exact) < 2.0);
  CHECK(largest_error(uniform(-2.0, 2.0), f, exact) < 2.0);
  CHECK(largest_error(uniform(-1e-8, 1e-8), f, exact) < 1.0);
}

TEST_CASE("fast_exp at the ends, at zero and of NaN") {
  for (const double x : {709.79, 1e4, inf}) {
    CHECK(shoal::fast_exp(x) == inf);
    CHECK(shoal::fast_exp(Pack(x))[1] == inf);
  }
  for (const double x : {-707.1, -1e300, -inf}) {
    CHECK(shoal::fast_exp(x) == 0.0);
    CHECK(shoal::fast_exp(Pack(x))[1] == 0.0);
  }
  CHECK(shoal::fast_exp(709.78) == doctest::Approx(std::exp(709.78)));
  CHECK(shoal::fast_exp(0.0) == 1.0);
  CHECK(shoal::fast_exp(Pack(-0.0))[0] == 1.0);
  CHECK(std::isnan(shoal::fast_exp(not_a_number)));
  CHECK(std::isnan(shoal::fast_exp(Pack(not_a_number))[0]));
}

TEST_CASE("fast_log is within 2 ulp for all magnitudes, and near 1") {
  const auto f = [](auto x) { return shoal::fast_log(x); };
  const auto exact = [](long double x) { return std::log(x); };
  CHECK(largest_error(magnitude(-700, 700), f, exact) < 2.0);
  CHECK(largest_error(uniform(0.5, 2.0), f, exact) < 2.0);
  CHECK(largest_error(uniform(1.0 - 1e-6, 1.0 + 1e-6), f, exact) < 2.0);
}

TEST_CASE("fast_log at the ends and outside") {
  CHECK(shoal::fast_log(1.0) == 0.0);
  CHECK(shoal::fast_log(0.0) == -inf);
  CHECK(shoal::fast_log(inf) == inf);
  CHECK(std::isnan(shoal::fast_log(-1.0)));
  CHECK(std::isnan(shoal::fast_log(not_a_number)));
  const double x[8] = {0.0, -2.0, inf, 1.0, not_a_number, 0.5, 4.0, 1e-310};
  const Pack y = shoal::fast_log(Pack::load(x));
  CHECK(y[0] == -inf);
  CHECK(std::isnan(y[1]));
  CHECK(y[2] == inf);
  CHECK(y[3] == 0.0);
}

// The difference 1 - e^-z costs up to 1 / (e^0.35 - 1) = 2.4 times the error of the exponential, just outside the range
// of the series.
TEST_CASE("relaxation is exact to 5 ulp, and 1 at z = 0") {
  const auto mean = [](auto z) { return shoal::relaxation(z).mean; };
  const auto exact = [](long double z) { return -std::expm1(-z) / z; };
  CHECK(largest_error(magnitude(-200, 6), mean, exact) < 5.0);
  CHECK(largest_error(uniform(0.2, 0.5), mean, exact) < 5.0);
  CHECK(largest_error(uniform(-5.0, -1e-3), mean, exact) < 5.0);
  const auto decay = [](auto z) { return shoal::relaxation(z).decay; };
  CHECK(largest_error(uniform(-3, 700), decay, [](long double z) { return std::exp(-z); }) < 2.0);
  CHECK(shoal::relaxation(0.0).mean == 1.0);
  CHECK(shoal::relaxation(0.0).decay == 1.0);
  CHECK(shoal::relaxation(Pack(0.0)).mean[0] == 1.0);
  CHECK(shoal::relaxation(Pack(1e-300)).mean[0] == 1.0);
  CHECK(shoal::relaxation(1e6).decay == 0.0);
  CHECK(shoal::relaxation(1e6).mean == 1e-6);
  CHECK(std::isnan(shoal::relaxation(not_a_number).mean));
  CHECK(std::isnan(shoal::relaxation(Pack(not_a_number)).mean[1]));
}

TEST_CASE("a lane of relaxation does not depend on the other lanes") {
  // Packs of small arguments alone take a shorter way.
  for (const double small : {1e-3, -0.2, 0.3}) {
    Pack mixed(small);
    mixed.set(1, 30.0);
    const auto alone = shoal::relaxation(Pack(small)), together = shoal::relaxation(mixed);
    CHECK(alone.mean[0] == together.mean[0]);
    CHECK(alone.decay[0] == together.decay[0]);
  }
}
