// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Smoothing kernels against quadrature (normalisation, moments), finite differences (slope) and themselves (pack
// against scalar, form for r = 0 against the general one).
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "shoal/smoothing_kernel.hpp"

namespace {

using shoal::lanes;
using shoal::Pack;
using shoal::SmoothingKernel;

// Integral over [a, b] by Gauss-Legendre with 20 nodes: exact for the splines between their knots.
template <class F>
double integrate(F&& f, double a, double b) {
  constexpr int n = 20;
  double sum = 0;
  for (int k = 0; k < n; ++k) {
    double x = std::cos(std::numbers::pi * (k + 0.75) / (n + 0.5)), slope = 1;
    for (int iteration = 0; iteration < 50; ++iteration) {  // Newton on the Legendre polynomial
      double p0 = 1, p1 = x;
      for (int m = 2; m <= n; ++m) {
        const double p2 = ((2 * m - 1) * x * p1 - (m - 1) * p0) / m;
        p0 = p1;
        p1 = p2;
      }
      slope = n * (x * p1 - p0) / (x * x - 1);
      const double step = p1 / slope;
      x -= step;
      if (std::abs(step) < 1e-16) break;
    }
    sum += 2 / ((1 - x * x) * slope * slope) * f(0.5 * (a + b) + 0.5 * (b - a) * x);
  }
  return 0.5 * (b - a) * sum;
}

// Integral over the ball of the cut-off of a function of r; knots of all kernels lie at multiples of h.
template <int D, class Kernel, class F>
double integrate_ball(const Kernel& kernel, F&& f) {
  const double sphere = D == 2 ? 2 * std::numbers::pi : 4 * std::numbers::pi;
  double sum = 0;
  const double h = kernel.h();
  for (int piece = 0; piece < std::lround(Kernel::support); ++piece)
    sum +=
        integrate([&](double r) { return sphere * std::pow(r, D - 1) * f(r); }, piece * h, (piece + 1) * h);
  return sum;
}

template <int D, class F>
void for_all_kernels(double h, F&& f) {
  const auto check = [&](auto kernel, SmoothingKernel kind) {
    INFO(shoal::to_string(kind) << " in " << D << "D, h = " << h);
    f(kernel, kind);
  };
  check(shoal::WendlandC2<D>(h), SmoothingKernel::wendland_c2);
  check(shoal::WendlandC4<D>(h), SmoothingKernel::wendland_c4);
  check(shoal::CubicSpline<D>(h), SmoothingKernel::cubic_spline);
  check(shoal::QuinticSpline<D>(h), SmoothingKernel::quintic_spline);
  check(shoal::Hyperbolic<D>(h), SmoothingKernel::hyperbolic);
  check(shoal::LaguerreGauss<D>(h), SmoothingKernel::laguerre_gauss);
}
template <class F>
void for_all_dimensions(F&& f) {
  for (double h : {0.01, 1.0, 37.0}) {
    for_all_kernels<2>(h, [&](auto kernel, auto kind) { f(kernel, kind, std::integral_constant<int, 2>{}); });
    for_all_kernels<3>(h, [&](auto kernel, auto kind) { f(kernel, kind, std::integral_constant<int, 3>{}); });
  }
}

// Two copies of a formula differ only where the compiler fuses other products and sums in them: in a dozen roundings of at
// most half an epsilon each, of terms up to 8 times as large as W(0) (the quintic spline's; the rest are smaller).
#if defined(__FMA__) || defined(__ARM_FEATURE_FMA)
constexpr double fusing = 64 * std::numeric_limits<double>::epsilon();
#else
constexpr double fusing = 0.0;
#endif

}  // namespace

TEST_CASE("a smoothing kernel integrates to one") {
  for_all_dimensions([](auto kernel, auto, auto d) {
    CHECK(std::abs(integrate_ball<d()>(kernel, [&](double r) { return kernel.w(r); }) - 1) < 1e-12);
  });
}

TEST_CASE("the first moment of the gradient is minus the identity") {
  // int (dW/dr) x_a x_b / r dV = delta_ab / D int (dW/dr) r dV by isotropy
  for_all_dimensions([](auto kernel, auto, auto d) {
    const double moment = integrate_ball<d()>(kernel, [&](double r) { return kernel.dw(r) * r; }) / d();
    CHECK(std::abs(moment + 1) < 1e-12);
    const double by_ratio =
        integrate_ball<d()>(kernel, [&](double r) { return kernel.dw_over_r(r) * r * r; }) / d();
    CHECK(std::abs(by_ratio + 1) < 1e-12);
  });
}

TEST_CASE("the weight of fits is a smoothing kernel too") {
  const auto check = [](auto kernel, auto d) {
    CHECK(std::abs(integrate_ball<d()>(kernel, [&](double r) { return kernel.w(r); }) - 1) < 1e-12);
    const double moment = integrate_ball<d()>(kernel, [&](double r) { return kernel.dw(r) * r; }) / d();
    CHECK(std::abs(moment + 1) < 1e-12);
    for (const double q : {0.1, 0.7, 1.3, 1.9}) {
      const double r = q * kernel.h(), step = 1e-6 * kernel.h();
      const double slope = (kernel.w(r + step) - kernel.w(r - step)) / (2 * step);
      CHECK(kernel.dw(r) == doctest::Approx(slope).epsilon(1e-6).scale(kernel.w(0.0) / kernel.h()));
      CHECK(kernel.dw_over_r(r) * r == doctest::Approx(kernel.dw(r)));
    }
    CHECK(kernel.w(kernel.cutoff()) == 0.0);
    CHECK(kernel.w(shoal::Pack(0.4 * kernel.h()))[1] == doctest::Approx(kernel.w(0.4 * kernel.h())));
  };
  check(shoal::WendlandC6<2>(0.3), std::integral_constant<int, 2>{});
  check(shoal::WendlandC6<3>(0.7), std::integral_constant<int, 3>{});
}

TEST_CASE("the Laguerre-Gauss kernel has no second moment, the others have") {
  for_all_dimensions([](auto kernel, auto kind, auto d) {
    const double h = kernel.h();
    const double second =
        integrate_ball<d()>(kernel, [&](double r) { return kernel.w(r) * r * r / (h * h); });
    if (kind == SmoothingKernel::laguerre_gauss)
      CHECK(std::abs(second) < 1e-12);
    else
      CHECK(second > 0.4);
  });
}

TEST_CASE("the slope is the derivative of the kernel") {
  for_all_dimensions([](auto kernel, auto, auto) {
    const double h = kernel.h(), eps = 1e-5 * h, scale = kernel.w(0.0) / h;
    for (double q = 0.02; q < kernel.support + 0.3; q += 0.0131) {
      if (std::abs(q - kernel.support) < 2e-5) continue;
      const double r = q * h;
      const double difference = (kernel.w(r + eps) - kernel.w(r - eps)) / (2 * eps);
      // error of the central difference: eps^2 W'''/6 (about 1e-9 of the scale) and rounding, 1e-16 / 1e-5
      CHECK(std::abs(kernel.dw(r) - difference) < 2e-9 * scale);
      CHECK(std::abs(kernel.dw_over_r(r) * r - kernel.dw(r)) < 1e-14 * scale);
    }
  });
}

TEST_CASE("a smoothing kernel is continuous at the cut-off and exactly zero beyond") {
  for_all_dimensions([](auto kernel, auto kind, auto) {
    const double radius = kernel.cutoff(), w0 = kernel.w(0.0), scale = w0 / kernel.h();
    CHECK(radius == kernel.support * kernel.h());
    CHECK(radius == shoal::cutoff_radius(kind, kernel.h()));
    CHECK(std::abs(kernel.w(radius * (1 - 1e-9))) < 1e-8 * w0);
    // only the cut Gaussian has a step in its slope: 0.037 of W(0)/h in 2D, 0.030 in 3D
    CHECK(std::abs(kernel.dw(radius * (1 - 1e-9))) <
          (kind == SmoothingKernel::laguerre_gauss ? 0.05 : 1e-8) * scale);
    for (double factor : {1.0 + 1e-12, 1.5, 1e3, 1e12}) {
      CHECK(kernel.w(factor * radius) == 0.0);
      CHECK(kernel.dw(factor * radius) == 0.0);
      CHECK(kernel.dw_over_r(factor * radius) == 0.0);
    }
  });
}

TEST_CASE("positive kernels fall monotonically") {
  for_all_dimensions([](auto kernel, auto kind, auto) {
    if (kind == SmoothingKernel::laguerre_gauss) return;  // negative in its outer ring by design
    int wrong = 0;
    for (double q = 0.001; q < kernel.support; q += 0.001)
      wrong += kernel.dw(q * kernel.h()) > 0 || kernel.w(q * kernel.h()) < 0;
    CHECK(wrong == 0);
  });
}

TEST_CASE("kernels are finite at r = 0 and pass a NaN on") {
  for_all_dimensions([](auto kernel, auto, auto) {
    CHECK(kernel.w(0.0) > 0);
    CHECK(std::isfinite(kernel.dw(0.0)));
    CHECK(std::isfinite(kernel.dw_over_r(0.0)));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(std::isnan(kernel.w(nan)));
    CHECK(std::isnan(kernel.dw(nan)));
    CHECK(std::isnan(kernel.w(Pack(nan))[lanes - 1]));
  });
}

TEST_CASE("kernels of packs equal kernels of doubles") {
  for_all_dimensions([&](auto kernel, auto, auto) {
    const double h = kernel.h(), w0 = kernel.w(0.0);
    double worst_w = 0, worst_dw = 0, worst_ratio = 0;
    for (double q = 0.0; q < kernel.support + 0.2; q += 0.01) {
      double r[lanes];
      for (int k = 0; k < lanes; ++k) r[k] = h * (q + 0.0013 * k);
      const Pack w = kernel.w(Pack::load(r)), dw = kernel.dw(Pack::load(r)),
                 ratio = kernel.dw_over_r(Pack::load(r));
      for (int k = 0; k < lanes; ++k) {
        worst_w = std::max(worst_w, std::abs(w[k] - kernel.w(r[k])) / w0);
        worst_dw = std::max(worst_dw, std::abs(dw[k] - kernel.dw(r[k])) * h / w0);
        const double size = std::max(std::abs(kernel.dw_over_r(r[k])), w0 / (h * h));
        worst_ratio = std::max(worst_ratio, std::abs(ratio[k] - kernel.dw_over_r(r[k])) / size);
      }
    }
    CHECK(worst_w <= fusing);
    CHECK(worst_dw <= fusing);
    CHECK(worst_ratio <= fusing);
  });
}

TEST_CASE("kernels are chosen by name") {
  std::set<double> values;
  for (auto name : shoal::smoothing_kernel_names) {
    const auto kind = shoal::smoothing_kernel_from_name(name);
    REQUIRE(kind.has_value());
    CHECK(shoal::to_string(*kind) == name);
    values.insert(shoal::with_kernel<3>(*kind, 1.0, [](auto kernel) { return kernel.w(0.4); }));
  }
  CHECK(values.size() == shoal::smoothing_kernel_names.size());
  CHECK_FALSE(shoal::smoothing_kernel_from_name("gaussian").has_value());
}

TEST_CASE("with_kernel gives the kernel of the name") {
  for_all_dimensions([](auto kernel, SmoothingKernel kind, auto dimensions) {
    shoal::with_kernel<dimensions()>(kind, kernel.h(), [&](const auto& chosen) {
      CHECK(chosen.h() == kernel.h());
      CHECK(chosen.cutoff() == kernel.cutoff());
      const double w0 = kernel.w(0.0), h = kernel.h();
      for (double q = 0.0; q < 3.2; q += 0.1) {
        const double r = q * h;
        CHECK(std::abs(chosen.w(r) - kernel.w(r)) <= fusing * w0);
        CHECK(std::abs(chosen.dw(r) - kernel.dw(r)) <= fusing * w0 / h);
        const double size =
            std::max(std::abs(kernel.dw_over_r(r)), w0 / (h * h));  // hyperbolic: infinite slope
        CHECK(std::abs(chosen.dw_over_r(r) - kernel.dw_over_r(r)) <= fusing * size);
        const shoal::Pack same = chosen.w(shoal::Pack(r));
        CHECK(same[0] == doctest::Approx(kernel.w(r)).epsilon(1e-14));
      }
    });
  });
}
