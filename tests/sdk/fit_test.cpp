// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The quadratic fit on disordered particles, with and without a free surface: exact derivatives of quadratic fields,
// the weights against a least-squares problem solved plainly, and what is left where neighbours are few.
#include "shoal/fit.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "shoal/testing.hpp"

using namespace shoal;
using shoal::testing::Body;

namespace {

constexpr double spacing = 0.01, h = 1.3 * spacing;

// A lattice of n^D particles, each moved by up to 20 % of the spacing: all of the body is near its surface.
Body disordered(int dimensions, int n, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> shake(-0.2 * spacing, 0.2 * spacing);
  std::vector<double> x;
  for (int k = 0; k < (dimensions == 3 ? n : 1); ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        x.push_back(spacing * i + shake(random));
        x.push_back(spacing * j + shake(random));
        if (dimensions == 3) x.push_back(spacing * k + shake(random));
      }
  return Body(dimensions, std::move(x));
}

struct Derivatives : PairOperator<Derivatives> {
  static constexpr bool row_by_row = true;
  template <int D>
  using Kernel = FitKernel<D>;

  In<FitDerivatives> fit{"fit", unit("1"), doc("Fit."), own_only};
  In<FitGradient> gradient_fit{"gradient_fit", unit("1"), doc("Fit."), own_only};
  In<FitLaplacian> laplacian_fit{"laplacian_fit", unit("1"), doc("Fit."), own_only};
  In<Scalar> f{"f", unit("1"), doc("A field.")};
  Out<Array<5, 9>> all{"all", unit("1"), doc("All derivatives.")};
  Out<Vector> gradient{"gradient", unit("1/m"), doc("Gradient.")};
  Out<Scalar> laplacian{"laplacian", unit("1/m2"), doc("Laplacian.")};

  auto pair(const auto& p) const {
    const auto jump = p.j(f) - p.i(f);
    return sums(jump * fit_derivatives(p, p.i(fit)), jump * fit_gradient(p, p.i(gradient_fit)),
                jump * fit_laplacian(p, p.i(laplacian_fit)));
  }
  void particle(auto i, const auto& d, auto g, auto l) const {
    for (std::size_t k = 0; k < all[i].size(); ++k) all[i][k] = d[static_cast<int>(k)];
    gradient[i] = g;
    laplacian[i] = l;
  }
};

template <class Rows>
void solve(Body& body, const char* field, double eps = 0.0) {
  QuadraticFit<Rows> fit;
  fit.rows.rename(field);
  fit.eps = eps;
  testing::run(fit, body, {&body}, {.smoothing_length = h});
}

void differentiate(Body& body, double eps = 0.0) {
  solve<FitDerivatives>(body, "fit", eps);
  solve<FitGradient>(body, "gradient_fit", eps);
  solve<FitLaplacian>(body, "laplacian_fit", eps);
  Derivatives derivatives;
  testing::run(derivatives, body, {&body}, {.smoothing_length = h});
}

// f = a + b . x + x . C x with C symmetric, and its derivatives at x in the order of the monomials.
template <int D>
struct Quadratic {
  std::array<double, 3> b{1.5, -0.7, 0.4};
  std::array<std::array<double, 3>, 3> c{{{3.0, 0.5, -1.0}, {0.5, -2.0, 0.25}, {-1.0, 0.25, 4.0}}};
  double scale = 1.0;

  double value(const double* x) const {
    double sum = 2.0;
    for (std::size_t a = 0; a < D; ++a) {
      sum += b[a] * x[a];
      for (std::size_t e = 0; e < D; ++e) sum += scale * c[a][e] * x[a] * x[e];
    }
    return sum;
  }
  std::vector<double> derivatives(const double* x) const {
    std::vector<double> d;
    for (std::size_t a = 0; a < D; ++a) {
      d.push_back(b[a]);
      for (std::size_t e = 0; e < D; ++e) d.back() += 2.0 * scale * c[a][e] * x[e];
    }
    for (std::size_t a = 0; a < D; ++a)
      for (std::size_t e = a; e < D; ++e) d.push_back(2.0 * scale * c[a][e]);
    return d;
  }
};

// The derivatives f_x, f_y, f_xx, f_xy, f_yy that fit the neighbours of i best, by Gaussian elimination of the normal
// equations with more digits than doubles have.
std::array<long double, 5> least_squares(const std::vector<double>& x, const std::vector<double>& f,
                                         std::size_t i) {
  const FitKernel<2> weight(h);
  std::array<std::array<long double, 6>, 5> a{};
  for (std::size_t j = 0; 2 * j < x.size(); ++j) {
    const long double dx = x[2 * j] - x[2 * i], dy = x[2 * j + 1] - x[2 * i + 1];
    const std::array<long double, 6> row{dx, dy, dx * dx / 2, dx * dy, dy * dy / 2, f[j] - f[i]};
    const long double w = i == j ? 0.0 : weight.w(static_cast<double>(std::hypot(dx, dy)));
    for (std::size_t r = 0; r < 5; ++r)
      for (std::size_t c = 0; c < 6; ++c) a[r][c] += w * row[r] * row[c];
  }
  for (std::size_t p = 0; p < 5; ++p)
    for (std::size_t r = 0; r < 5; ++r) {
      if (r == p) continue;
      const long double factor = a[r][p] / a[p][p];
      for (std::size_t c = p; c < 6; ++c) a[r][c] -= factor * a[p][c];
    }
  std::array<long double, 5> solution{};
  for (std::size_t k = 0; k < 5; ++k) solution[k] = a[k][5] / a[k][k];
  return solution;
}

template <int D>
void check_quadratic() {
  Body body = disordered(D, D == 2 ? 14 : 7, 7u + D);
  const Quadratic<D> field;
  const auto x = body["position"];
  body.set_each("f", 1, [&](std::size_t i, std::size_t) { return field.value(&x[i * D]); });
  differentiate(body);
  for (std::size_t i = 0; i < body.size(); ++i) {
    const std::vector<double> exact = field.derivatives(&x[i * D]);
    CAPTURE(i);
    double laplacian = 0;
    for (std::size_t k = 0; k < fit_terms<D>; ++k) {
      CHECK(body["all"][i * fit_terms<D> + k] == doctest::Approx(exact[k]).epsilon(1e-7));
      if (k < D) CHECK(body["gradient"][i * D + k] == doctest::Approx(exact[k]).epsilon(1e-7));
    }
    for (std::size_t a = 0; a < D; ++a) laplacian += 2.0 * field.c[a][a];
    CHECK(body["laplacian"][i] == doctest::Approx(laplacian).epsilon(1e-7));
  }
}

}  // namespace

TEST_CASE("derivatives of quadratic fields are exact on disordered particles and at the surface") {
  check_quadratic<2>();
  check_quadratic<3>();
}

TEST_CASE("the fit is the least-squares solution of each neighbourhood") {
  Body body = disordered(2, 9, 3);
  const auto x = body["position"];
  body.set_each("f", 1, [&](std::size_t i, std::size_t) {
    return std::sin(40.0 * x[2 * i]) * std::cos(70.0 * x[2 * i + 1]);
  });
  differentiate(body);
  const auto f = body["f"];
  for (std::size_t i = 0; i < body.size(); ++i) {
    const std::array<long double, 5> c = least_squares(x, f, i);
    CAPTURE(i);
    for (std::size_t k = 0; k < 5; ++k)
      CHECK(body["all"][5 * i + k] ==
            doctest::Approx(static_cast<double>(c[k])).epsilon(1e-9).scale(k < 2 ? 70.0 : 4900.0));
  }
}

TEST_CASE("regularised, linear fields stay exact") {
  Body body = disordered(3, 6, 11);
  Quadratic<3> field;
  field.scale = 0.0;
  const auto x = body["position"];
  body.set_each("f", 1, [&](std::size_t i, std::size_t) { return field.value(&x[i * 3]); });
  differentiate(body, 0.01);
  for (std::size_t i = 0; i < body.size(); ++i)
    for (std::size_t a = 0; a < 3; ++a)
      CHECK(body["gradient"][i * 3 + a] == doctest::Approx(field.b[a]).epsilon(1e-9));
}

TEST_CASE("few neighbours leave the linear fit, and fewer nothing") {
  // Three neighbours that span the plane, and one far away that sees a single other.
  Body body(2, {0, 0, 1e-2, 0, 0, 1e-2, -9e-3, -8e-3, 1.0, 1.0, 1.01, 1.0});
  const auto x = body["position"];
  body.set_each("f", 1, [&](std::size_t i, std::size_t) { return 3.0 * x[2 * i] - 2.0 * x[2 * i + 1]; });
  differentiate(body);
  CHECK(body["gradient"][0] == doctest::Approx(3.0));
  CHECK(body["gradient"][1] == doctest::Approx(-2.0));
  CHECK(body["laplacian"][0] == 0.0);
  for (std::size_t k = 8; k < 12; ++k) CHECK(body["gradient"][k] == 0.0);
}
