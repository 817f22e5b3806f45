// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Waves on a line, and coefficients that give them their speed on coarse ones.
#include "wave_speed.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "aliev_panfilov.hpp"
#include "allen_cahn.hpp"
#include "cells.hpp"
#include "line_weights.hpp"

using namespace shoal;
using namespace shoal::diffusion;
using namespace shoal::diffusion::test;

namespace {

const shoal_host silent_host = [] {
  shoal_host host{};
  host.size = sizeof host;
  host.log = [](std::uint32_t, const char*) {};
  host.fail = [](const char*) {};
  return host;
}();

// u (u - a)(1 - u) alone, whose wave is known: c = sqrt(k D / 2) (1 - 2 a).
struct Bistable final : ReactionModel<Bistable, 1> {
  std::vector<ReactionVariable> variables() const { return {{"potential", "1", "u", 0.0, 1e-4, 1.0}}; }
  double largest_step() const { return 0.05; }
  template <Real R>
  Rates<R, 1> rates(const std::array<R, 1>& y) const {
    const CubicRate<R> cubic = bistable(y[0], 2.0, 0.2);
    return {{cubic.q}, {cubic.p}};
  }
};
double exact_speed(double diffusivity) { return std::sqrt(diffusivity) * 0.6; }

double speed_on_line(std::vector<double> weights, double spacing) {
  const Bistable model;
  const ReactionIntegrator integrator(interface_of(model));
  return wave_speed(integrator, {std::move(weights), spacing, 0.05, 120, 1e4});
}

// Sum over all neighbours in a square or cube of the lattice, written out.
template <int D>
std::vector<double> plain_line_weights(double h, double dx, const AxisValues& d, int axis) {
  std::vector<double> line(8, 0.0);
  with_kernel<D>(SmoothingKernel::wendland_c2, h, [&](const auto& kernel) {
    const LatticeMoments<D> lattice(kernel, dx);
    Mat<D> k{};
    for (int a = 0; a < D; ++a) k(a, a) = d[static_cast<std::size_t>(a)];
    for (int x = -8; x <= 8; ++x)
      for (int y = -8; y <= 8; ++y)
        for (int z = D == 3 ? -8 : 0; z <= (D == 3 ? 8 : 0); ++z) {
          const int n[3] = {x, y, z};
          if (n[axis] <= 0) continue;
          Vec<D> r{};
          for (int a = 0; a < D; ++a) r[a] = n[a] * dx;
          const Vec<D> e = (1.0 / norm(r)) * r;
          line[static_cast<std::size_t>(n[axis] - 1)] -=
              2.0 * std::pow(dx, D) * dot(e, lattice.b_of(k) * e) * kernel.dw_over_r(norm(r));
        }
  });
  return line;
}

}  // namespace

TEST_CASE("a wave on a line runs at its known speed, with an error of second order") {
  const double d = 0.7, exact = exact_speed(d);
  const auto error = [&](double dx) {
    return std::fabs(speed_on_line(second_difference(d, dx), dx) / exact - 1.0);
  };
  const double coarse = error(1.0), fine = error(0.5);
  CHECK(coarse > 0.02);
  CHECK(fine < 0.02);
  CHECK(coarse / fine > 3.0);
}

TEST_CASE("line weights of the pairwise scheme are its sums over planes, and hold the coefficient") {
  const double dx = 0.3, h = 1.3 * dx;
  const AxisValues d{2.0, 0.4, 0.9};
  for (int axis = 0; axis < 3; ++axis) {
    const auto plain = plain_line_weights<3>(h, dx, d, axis);
    with_kernel<3>(SmoothingKernel::wendland_c2, h, [&](const auto& kernel) {
      const auto line = pairwise_line_weights<3>(kernel, dx, false, d, static_cast<std::size_t>(axis));
      double second_moment = 0;
      for (std::size_t n = 0; n < line.size(); ++n) {
        CHECK(line[n] == doctest::Approx(plain[n]).epsilon(1e-12));
        second_moment += line[n] * std::pow(static_cast<double>(n + 1) * dx, 2);
      }
      CHECK(second_moment == doctest::Approx(d[static_cast<std::size_t>(axis)]).epsilon(1e-12));
    });
  }
}

TEST_CASE("line weights of the accurate scheme hold the coefficient, whatever it is across the line") {
  const double dx = 0.3, h = 1.3 * dx;
  for (int axis = 0; axis < 3; ++axis)
    with_kernel<3>(SmoothingKernel::wendland_c2, h, [&](const auto& kernel) {
      const AxisValues d{2.0, 0.4, 0.9};
      const auto line = fit_line_weights<3>(kernel, dx, d, static_cast<std::size_t>(axis));
      REQUIRE_FALSE(line.empty());
      double second_moment = 0;
      for (std::size_t n = 0; n < line.size(); ++n)
        second_moment += line[n] * std::pow(static_cast<double>(n + 1) * dx, 2);
      CHECK(second_moment == doctest::Approx(d[static_cast<std::size_t>(axis)]).epsilon(1e-9));
    });
}

TEST_CASE("corrected coefficients give a coarse line the speed of a fine one") {
  shoal::impl::host_table = &silent_host;
  const DefaultObject<Bistable> model("test.bistable");
  double last = 1e300;
  for (const double dx : {3.0, 1.5, 0.75}) {
    const WaveSpeedCorrection correction(model.object(), 2, dx, [&](const AxisValues& d, std::size_t axis) {
      return second_difference(d[axis], dx);
    });
    const AxisValues d{1.0, 0.3, 0.0}, raised = correction(d);
    CAPTURE(dx);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      CHECK(raised[axis] > d[axis]);
      CHECK(speed_on_line(second_difference(raised[axis], dx), dx) ==
            doctest::Approx(exact_speed(d[axis])).epsilon(0.01));
    }
    CHECK(speed_on_line(second_difference(d[1], dx), dx) < 0.97 * exact_speed(d[1]));
    // The correction vanishes with the spacing.
    CHECK(raised[0] - d[0] < 0.4 * last);
    last = raised[0] - d[0];
  }
}

TEST_CASE("a tensor is corrected along its axes, however they lie") {
  shoal::impl::host_table = &silent_host;
  const DefaultObject<Bistable> model("test.bistable");
  const WaveSpeedCorrection correction(model.object(), 2, 1.5, [](const AxisValues& d, std::size_t axis) {
    return second_difference(d[axis], 1.5);
  });
  const AxisValues along{1.0, 0.3, 0.0}, raised = correction(along);
  const double c = std::cos(0.6), s = std::sin(0.6);
  Mat<2> turn{};
  turn(0, 0) = turn(1, 1) = c;
  turn(0, 1) = -s;
  turn(1, 0) = s;
  const auto turned = [&](const AxisValues& d) {
    Mat<2> k{};
    k(0, 0) = d[0];
    k(1, 1) = d[1];
    return turn * k * transpose(turn);
  };
  const Mat<2> got = correction(turned(along)), expected = turned(raised);
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b) CHECK(got(a, b) == doctest::Approx(expected(a, b)).epsilon(1e-6));
  CHECK(correction(1.0) == doctest::Approx(correction(AxisValues{1.0, 1.0, 0.0})[1]));
}

TEST_CASE("a model without waves cannot correct anything") {
  shoal::impl::host_table = &silent_host;
  const DefaultObject<AllenCahn> model("diffusion.allen_cahn");
  try {
    const WaveSpeedCorrection correction(model.object(), 2, 1.0, [](const AxisValues& d, std::size_t axis) {
      return second_difference(d[axis], 1.0);
    });
    FAIL("no error");
  } catch (const CaseError& error) {
    CHECK(std::string(error.what()) ==
          "case.yaml:1:1: diffusion.allen_cahn has no waves that run from where it is excited; leave "
          "wave_speed_of "
          "out");
  }
}
