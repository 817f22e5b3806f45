// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The weights of the reference configuration against slow obvious code, and what they must be exact for.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>

#include "particles.hpp"
#include "reference_weights.hpp"
#include "shoal/smoothing_kernel.hpp"
#include "tangent.hpp"

using namespace shoal;
using namespace shoal::solid;
using solid_test::deformation;
using solid_test::dx;
using solid_test::force;

namespace {

ReferenceWeights weights_of(testing::Body& body, const solid_test::Neighbours& neighbours,
                            const ReferenceSettings& settings) {
  ReferenceWeights weights;
  weights.build(body.dimensions(), settings, neighbours.list, solid_test::geometry(body));
  return weights;
}

// Solves m c = b by Gaussian elimination with pivoting.
std::vector<long double> solve(std::vector<std::vector<long double>> m, std::vector<long double> b) {
  const std::size_t n = b.size();
  for (std::size_t c = 0; c < n; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c; r < n; ++r)
      if (std::fabs(m[r][c]) > std::fabs(m[pivot][c])) pivot = r;
    std::swap(m[c], m[pivot]);
    std::swap(b[c], b[pivot]);
    for (std::size_t r = 0; r < n; ++r) {
      if (r == c) continue;
      const long double factor = m[r][c] / m[c][c];
      for (std::size_t k = c; k < n; ++k) m[r][k] -= factor * m[c][k];
      b[r] -= factor * b[c];
    }
  }
  for (std::size_t c = 0; c < n; ++c) b[c] /= m[c][c];
  return b;
}

// How far neighbours are on one side of particle i: 0 on a lattice, away from surfaces.
template <int D>
double asymmetry_of(testing::Body& body, std::size_t i) {
  const double h = solid_test::settings().smoothing_length;
  const WendlandC2<D> kernel(h);
  const auto& x = body["reference_position"];
  double around = 0, aside[D] = {}, shift = 0;
  for (std::size_t j = 0; j < body.size(); ++j) {
    if (i == j) continue;
    double square = 0;
    const auto away = [&](int a) {
      return (x[j * D + static_cast<std::size_t>(a)] - x[i * D + static_cast<std::size_t>(a)]) / h;
    };
    for (int a = 0; a < D; ++a) square += away(a) * away(a);
    const double w = body["volume"][j] * kernel.w(std::sqrt(square) * h);
    around += w;
    for (int a = 0; a < D; ++a) aside[a] += w * away(a);
  }
  for (const double component : aside) shift += component * component;
  return std::sqrt(shift) / around;
}

// Coefficients of the least-squares fit of values f around particle i: 1 (if it is free there), X, Y, ..., by the text
// book. Lengths are in smoothing lengths.
template <int D>
std::vector<long double> fit(testing::Body& body, const std::vector<double>& f, std::size_t i,
                             bool free_value, double eps) {
  const double h = solid_test::settings().smoothing_length;
  const WendlandC2<D> kernel(h);
  const auto& x = body["reference_position"];
  const double asymmetry = asymmetry_of<D>(body, i);
  const std::size_t n = D + D * (D + 1) / 2 + (free_value ? 1 : 0);
  std::vector<std::vector<long double>> m(n, std::vector<long double>(n, 0));
  std::vector<long double> b(n, 0);
  for (std::size_t j = 0; j < body.size(); ++j) {
    if (i == j) continue;
    double d[D], square = 0;
    for (int a = 0; a < D; ++a) {
      d[a] = (x[j * D + static_cast<std::size_t>(a)] - x[i * D + static_cast<std::size_t>(a)]) / h;
      square += d[a] * d[a];
    }
    std::vector<long double> p;
    if (free_value) p.push_back(1);
    for (int a = 0; a < D; ++a) p.push_back(d[a]);
    for (int a = 0; a < D; ++a)
      for (int c = a; c < D; ++c) p.push_back(d[a] * d[c]);
    // The residual's weight falls off as a parabola, so that it looks beyond the nearest layers, and but at surfaces is
    // even within 2.1 spacings.
    const double slow = asymmetry > 0.15                   ? std::max(0.0, 1.0 - square / 4.0)
                        : std::sqrt(square) * h < 2.1 * dx ? 1.0
                                                           : 0.0;
    const double w = body["volume"][j] * (free_value ? slow : kernel.w(std::sqrt(square) * h));
    for (std::size_t r = 0; r < n; ++r) {
      b[r] += w * p[r] * (f[j] - f[i]);
      for (std::size_t c = 0; c < n; ++c) m[r][c] += w * p[r] * p[c];
    }
  }
  if (!free_value && asymmetry > 0.53) eps *= 100.0;
  const std::size_t first = free_value ? 1 : 0;
  long double linear = 0;
  for (std::size_t k = first; k < first + D; ++k) linear += m[k][k];
  for (std::size_t k = first + D; k < n; ++k) m[k][k] += eps * linear;
  return solve(m, b);
}

template <int D>
void compare_with_fit(double disorder) {
  testing::Body body = solid_test::box(D, 7, disorder);
  const solid_test::Neighbours neighbours(body);
  ReferenceSettings settings = solid_test::settings();
  settings.consistent = false;
  const ReferenceWeights weights = weights_of(body, neighbours, settings);
  std::vector<double> f, values;
  for (std::size_t i = 0; i < body.size(); ++i) {
    f.push_back(std::sin(17.3 * static_cast<double>(i)));
    for (int a = 0; a < D; ++a) values.push_back(f.back());
  }
  for (std::size_t i = 0; i < body.size(); i += 5) {
    const auto [gradient, residual] = deformation<D>(weights.stencil(i), values.data(), i);
    const auto expected = fit<D>(body, f, i, false, settings.eps);
    for (int a = 0; a < D; ++a)
      CHECK(gradient(0, a) == doctest::Approx(static_cast<double>(expected[static_cast<std::size_t>(a)]) /
                                              settings.smoothing_length)
                                  .epsilon(1e-9));
    // The residual is -c_0 times the part of 1 that the monomials do not explain.
    const auto value = fit<D>(body, f, i, true, 0.0);
    std::vector<double> one(body.size(), 1.0);
    one[i] = 0.0;
    double gain = 0;
    const Stencil stencil = weights.stencil(i);
    for (std::uint32_t m = 0; m < stencil.n; ++m) gain += stencil.forward[m * (D + 1) + D];
    CHECK(residual[0] == doctest::Approx(-gain * static_cast<double>(value[0])).epsilon(1e-9));
    CHECK(gain > -1e-12);  // zero where there are no more neighbours than coefficients
    CHECK(gain < 1.0);
  }
}

// Largest difference of F from the gradient of a polynomial motion, and the largest residual over the spacing.
template <int D, class Motion, class Gradient>
std::array<double, 2> errors(const ReferenceSettings& settings, double disorder, Motion&& motion,
                             Gradient&& exact) {
  testing::Body body = solid_test::box(D, 8, disorder);
  const solid_test::Neighbours neighbours(body);
  const ReferenceWeights weights = weights_of(body, neighbours, settings);
  const auto& X = body["reference_position"];
  std::vector<double> x(X.size() + 4);
  const auto at = [&](std::size_t i) {
    Vec<D> place;
    for (int a = 0; a < D; ++a) place[a] = X[i * D + static_cast<std::size_t>(a)];
    return place;
  };
  for (std::size_t i = 0; i < body.size(); ++i) {
    const Vec<D> moved = motion(at(i));
    std::copy_n(moved.e, D, x.data() + i * D);
  }
  double gradient_error = 0, residual_error = 0;
  for (std::size_t i = 0; i < body.size(); ++i) {
    const auto [gradient, residual] = deformation<D>(weights.stencil(i), x.data(), i);
    const Mat<D> difference = gradient - exact(at(i));
    gradient_error = std::max(gradient_error, std::sqrt(double_dot(difference, difference)));
    residual_error = std::max(residual_error, norm(residual) / dx);
  }
  return {gradient_error, residual_error};
}

template <int D>
Mat<D> some_matrix() {
  Mat<D> A;
  for (int k = 0; k < D * D; ++k) A[k] = std::sin(3.0 * k + 1.0) + (k % (D + 1) == 0 ? 1.5 : 0.0);
  return A;
}

}  // namespace

TEST_CASE("weights are those of a least-squares fit") {
  compare_with_fit<2>(0.0);
  compare_with_fit<2>(0.2);
  compare_with_fit<3>(0.0);
  compare_with_fit<3>(0.2);
}

TEST_CASE("the residual of a lattice looks at no more than the next two layers") {
  const auto counts = []<int D>(std::uint32_t controlled, std::uint32_t all) {
    testing::Body body = solid_test::box(D, 11, 0.0);
    const solid_test::Neighbours neighbours(body);
    const ReferenceWeights weights = weights_of(body, neighbours, solid_test::settings());
    const Stencil stencil = weights.stencil(body.size() / 2);
    CHECK(stencil.controlled == controlled);
    CHECK(stencil.n == all);
    for (std::uint64_t i = 0; i < body.size(); ++i) {
      const Stencil one = weights.stencil(i);
      for (std::uint32_t m = one.controlled; m < one.n; ++m) {
        CHECK(one.forward[m * (D + 1) + D] == 0.0);
        CHECK(one.backward[m * (D + 1) + D] == 0.0);
      }
    }
  };
  counts.operator()<2>(12, 20);
  counts.operator()<3>(32, 56);
}

TEST_CASE("the residual sees what alternates in any direction") {
  // Inside a lattice, for motions (-1)^(kx X/dx) of unit size along one, two and three axes.
  const auto sees = []<int D>(const std::array<int, 3>& alternates, double least) {
    testing::Body body = solid_test::box(D, 7, 0.0);
    const solid_test::Neighbours neighbours(body);
    const ReferenceWeights weights = weights_of(body, neighbours, solid_test::settings());
    std::vector<double> u(body.size() * D + 4, 0.0);
    std::size_t middle = 0;
    for (std::size_t i = 0; i < body.size(); ++i) {
      long parity = 0;
      bool central = true;
      for (std::size_t a = 0; a < D; ++a) {
        const long cell = std::lround(body["reference_position"][i * D + a] / dx - 0.5);
        parity += alternates[a] * cell;
        central = central && cell == 3;
      }
      u[i * D] = parity % 2 == 0 ? 1.0 : -1.0;
      if (central) middle = i;
    }
    const auto [gradient, residual] = deformation<D>(weights.stencil(middle), u.data(), middle);
    CHECK(std::sqrt(double_dot(gradient, gradient)) * dx < 1e-9);
    CHECK(std::fabs(residual[0]) > least);
  };
  sees.operator()<2>({1, 0, 0}, 0.3);
  sees.operator()<2>({1, 1, 0}, 0.3);
  sees.operator()<3>({1, 0, 0}, 0.2);
  sees.operator()<3>({1, 1, 0}, 0.2);
  sees.operator()<3>({1, 1, 1}, 0.2);
}

TEST_CASE("linear motions are exact on any arrangement") {
  const auto check = []<int D>(bool quadratic, double disorder) {
    const Mat<D> A = some_matrix<D>();
    ReferenceSettings settings = solid_test::settings();
    settings.quadratic = quadratic;
    const auto [gradient, residual] = errors<D>(
        settings, disorder, [&](const Vec<D>& X) { return A * X; }, [&](const Vec<D>&) { return A; });
    CHECK(gradient < 1e-11);
    CHECK(residual < 1e-11);
  };
  for (const double disorder : {0.0, 0.2})
    for (const bool quadratic : {true, false}) {
      check.operator()<2>(quadratic, disorder);
      check.operator()<3>(quadratic, disorder);
    }
}

TEST_CASE("quadratic motions are exact without regularisation, also where weights were made consistent") {
  const auto check = []<int D>(double disorder) {
    ReferenceSettings settings = solid_test::settings();
    settings.eps = 0.0;
    const auto [gradient, residual] = errors<D>(
        settings, disorder,
        [](const Vec<D>& X) {
          Vec<D> x = X;
          x[0] += 0.4 * X[0] * X[1] - 0.2 * X[1] * X[1];
          x[1] += 0.3 * X[0] * X[0];
          return x;
        },
        [](const Vec<D>& X) {
          Mat<D> F = identity<D>();
          F(0, 0) += 0.4 * X[1];
          F(0, 1) += 0.4 * X[0] - 0.4 * X[1];
          F(1, 0) += 0.6 * X[0];
          return F;
        });
    CHECK(gradient < 1e-9);
    CHECK(residual < 1e-9);
  };
  check.operator()<2>(0.0);
  check.operator()<2>(0.1);
  check.operator()<3>(0.1);
}

TEST_CASE("a uniform stress exerts no force inside, and the area vectors close the surface") {
  const auto check = []<int D>(double disorder, double most) {
    testing::Body body = solid_test::box(D, 12, disorder);
    const solid_test::Neighbours neighbours(body);
    const double volume = std::pow(dx, D);
    double rms[2];
    for (const bool consistent : {false, true}) {
      ReferenceSettings settings = solid_test::settings();
      settings.consistent = consistent;
      const ReferenceWeights weights = weights_of(body, neighbours, settings);
      double square = 0, first_moment[D] = {}, sum[D] = {};
      std::size_t n = 0;
      for (std::size_t i = 0; i < body.size(); ++i) {
        double r[D];
        weights.residual(i, r);
        for (int a = 0; a < D; ++a) {
          sum[a] += r[a] * dx;
          first_moment[a] -= volume * r[a] * body["reference_position"][i * D + static_cast<std::size_t>(a)];
        }
        // On a lattice forces vanish where all neighbours have all of theirs; further out it takes the change.
        const double layers = disorder == 0.0 ? 4.0 : 2.0;
        if (body["signed_distance"][i] > -layers * settings.smoothing_length) continue;
        ++n;
        for (int a = 0; a < D; ++a) square += r[a] * dx * r[a] * dx;
      }
      rms[consistent] = std::sqrt(square / static_cast<double>(n));
      for (int a = 0; a < D; ++a) {
        CHECK(std::fabs(sum[a]) < 1e-9);
        // The divergence theorem: the integral of x N_x over the surface is the volume.
        CHECK(first_moment[a] == doctest::Approx(volume * static_cast<double>(body.size())).epsilon(1e-10));
      }
    }
    INFO("before ", rms[0], " after ", rms[1]);
    CHECK(rms[1] < most);
    if (disorder == 0.0)
      CHECK(rms[0] < 1e-12);
    else
      CHECK(rms[1] < 0.05 * rms[0]);
  };
  check.operator()<2>(0.0, 2e-3);
  check.operator()<2>(0.2, 0.02);
  check.operator()<3>(0.2, 0.02);
}

// The weights of each particle's own fit, without sharing, are what `fit` above is compared with; here the sums of
// particles that are looked at together, with a stencil that they share or each in a lane, are compared with those of
// one at a time.
template <int D>
void compare_runs(double disorder) {
  testing::Body body = solid_test::box(D, D == 2 ? 24 : 18, disorder);
  const solid_test::Neighbours neighbours(body);
  const ReferenceWeights weights = weights_of(body, neighbours, solid_test::settings());
  const std::size_t n = body.size();
  std::vector<double> x(n * D), F(n * D * D), q(n * D), P(n * D * D), f(n * D), free(n * D);
  for (std::size_t k = 0; k < x.size(); ++k)
    x[k] = body["reference_position"][k] + 0.1 * dx * std::sin(0.37 * static_cast<double>(k));
  for (std::size_t k = 0; k < P.size(); ++k) P[k] = std::sin(0.7 * static_cast<double>(k * k % 1013));
  x.resize(x.size() + 4), P.resize(P.size() + 4), q.resize(q.size() + 4);
  for (std::size_t begin = 0; begin < n; begin += 100)  // pieces, as the kernel hands them out
    weights.deform<D>(begin, std::min(n, begin + 100), x.data(), 3.0, F.data(), q.data());
  weights.force<D, true>(0, n, P.data(), q.data(), 2.0, f.data());
  weights.force<D, false>(0, n, P.data(), q.data(), 2.0, free.data());
  if (disorder == 0.0) {
    CHECK(weights.n_patterns() < (D == 2 ? 100 : 2500));
  } else {
    CHECK(weights.n_patterns() == n);
  }
  double wrong = 0;
  const auto compare = [&](double a, double b, double scale) {
    wrong = std::max(wrong, std::fabs(a - b) / scale);
  };
  for (std::size_t i = 0; i < n; ++i) {
    const auto one = deformation<D>(weights.stencil(i), x.data(), i);
    for (std::size_t k = 0; k < D * D; ++k) compare(F[i * D * D + k], one.gradient.e[k], 1.0);
    for (std::size_t k = 0; k < D; ++k) compare(q[i * D + k], 3.0 * one.residual.e[k], dx);
    const Vec<D> with = force<D>(weights.stencil(i), P.data(), q.data(), true, i);
    const Vec<D> without = force<D>(weights.stencil(i), P.data(), q.data(), false, i);
    for (std::size_t k = 0; k < D; ++k) compare(f[i * D + k], 2.0 * with.e[k], 1.0 / dx);
    for (std::size_t k = 0; k < D; ++k) compare(free[i * D + k], 2.0 * without.e[k], 1.0 / dx);
  }
  CHECK(wrong < 1e-12);
}

TEST_CASE("particles that are looked at together get what each would get alone") {
  compare_runs<2>(0.0);
  compare_runs<2>(0.2);
  compare_runs<3>(0.0);
  compare_runs<3>(0.2);
}

// The linear force has its own tests: it is that of the operators.
template <int D>
void compare_tangent(bool on_grid) {
  testing::Body body = solid_test::box(D, D == 2 ? 8 : 5, 0.15);
  const solid_test::Neighbours neighbours(body);
  const ReferenceWeights weights = weights_of(body, neighbours, solid_test::settings());
  PressureGrid grid;
  grid.build(D, body.size(), body["reference_position"].data(), body["volume"].data(), dx);
  Stiffness stiffness{1e6, 4e5, 2e5, 1000.0};
  if (on_grid) stiffness.grid = &grid, stiffness.bulk = 1.2e6;
  const std::size_t n = D * body.size();
  std::vector<double> F(n * D, 0.0), out(n + 8), expected(n);
  std::vector<std::int64_t> held(body.size(), 0);
  for (std::size_t i = 0; i < body.size(); ++i)
    for (std::size_t a = 0; a < D; ++a) F[i * D * D + a * D + a] = 1.0;
  held[3] = 1;
  AlignedNumbers u;
  weights.random_start(u);
  u.data()[3 * D] = 0.0;
  LinearSpace space;
  weights.linear_force(stiffness, u.data(), out.data(), space);
  double largest = 0;
  for (const auto& entry :
       tangent(D, {weights, body.size(), stiffness, dx, body["volume"].data(), F.data(), held.data()})) {
    const auto row = static_cast<std::size_t>(entry.row()), column = static_cast<std::size_t>(entry.col());
    CHECK(row >= column);
    expected[row] += entry.value() * u.data()[column];
    if (row != column) expected[column] += entry.value() * u.data()[row];
  }
  for (std::size_t k = 0; k < n; ++k) {
    if (k == 3 * D) continue;
    const double exact = -body["volume"][k / D] * out[k];
    largest = std::max(largest, std::fabs(expected[k] - exact) / (std::fabs(exact) + 1.0));
  }
  CHECK(largest < 1e-9);
  CHECK(expected[3 * D] == 0.0);
}

TEST_CASE("the stiffness matrix times a displacement is the linear force") {
  for (const bool on_grid : {false, true}) {
    compare_tangent<2>(on_grid);
    compare_tangent<3>(on_grid);
  }
}

// Constants and, inside, linear functions are their own means; a wave of two spacings has none.
TEST_CASE("the grid of pressure keeps smooth fields and takes alternating ones out") {
  testing::Body body = solid_test::box(2, 12, 0.0);
  PressureGrid grid;
  grid.build(2, body.size(), body["reference_position"].data(), body["volume"].data(), dx);
  CHECK(grid.n_nodes() == 49);
  const auto through = [&](auto&& f) {
    std::vector<double> values, nodes(grid.n_nodes()), out;
    for (std::size_t i = 0; i < body.size(); ++i)
      values.push_back(f(body["reference_position"][2 * i], body["reference_position"][2 * i + 1]));
    grid.means(values.data(), nodes.data());
    for (std::size_t i = 0; i < body.size(); ++i) out.push_back(grid.at(i, nodes.data()));
    return out;
  };
  const auto place = [](double x) { return static_cast<int>(std::lround(x / dx - 0.5)); };
  const auto constant = through([](double, double) { return 3.0; });
  const auto linear = through([](double x, double y) { return 2.0 * x - y; });
  const auto rows = through([&](double x, double) { return place(x) % 2 == 0 ? 1.0 : -1.0; });
  const auto checkers =
      through([&](double x, double y) { return (place(x) + place(y)) % 2 == 0 ? 1.0 : -1.0; });
  for (std::size_t i = 0; i < body.size(); ++i) {
    const double x = body["reference_position"][2 * i], y = body["reference_position"][2 * i + 1];
    CHECK(constant[i] == doctest::Approx(3.0).epsilon(1e-14));
    const bool inside = std::min({x, y, 1.2 - x, 1.2 - y}) > 2.0 * dx;
    if (inside) CHECK(linear[i] == doctest::Approx(2.0 * x - y).epsilon(1e-12));
    if (inside) CHECK(std::fabs(rows[i]) < 1e-13);
    if (inside) CHECK(std::fabs(checkers[i]) < 1e-13);
  }
}

TEST_CASE("the largest frequency is that of the explicit step's limit") {
  testing::Body body = solid_test::box(2, 8, 0.1);
  const solid_test::Neighbours neighbours(body);
  const ReferenceWeights weights = weights_of(body, neighbours, solid_test::settings());
  const Stiffness stiffness{1e6, 4e5, 2e5, 1000.0};
  const double limit = 2.0 / weights.largest_frequency(stiffness, body["volume"].data());
  // Verlet, from a small random displacement.
  const auto growth = [&](double dt) {
    const std::size_t n = body.size();
    std::vector<double> u(2 * n + 4), v(2 * n), P(4 * n + 4), q(2 * n + 4);
    for (std::size_t k = 0; k < 2 * n; ++k) u[k] = 1e-6 * std::sin(12.9898 * static_cast<double>(k));
    double largest = 0;
    for (int step = 0; step < 2000; ++step) {
      for (std::size_t i = 0; i < n; ++i) {
        const auto [gradient, residual] = deformation<2>(weights.stencil(i), u.data(), i);
        const Mat<2> strain = symmetric_part(gradient);
        const Mat<2> s = stiffness.lambda * trace(strain) * identity<2>() + 2.0 * stiffness.mu * strain;
        std::copy_n(s.e, 4, P.data() + 4 * i);
        for (int a = 0; a < 2; ++a)
          q[2 * i + static_cast<std::size_t>(a)] = stiffness.hourglass / (dx * dx) * residual[a];
      }
      for (std::size_t i = 0; i < n; ++i) {
        const Vec<2> f = force<2>(weights.stencil(i), P.data(), q.data(), true, i);
        for (int a = 0; a < 2; ++a) v[2 * i + static_cast<std::size_t>(a)] += dt / stiffness.density * f[a];
      }
      largest = 0;
      for (std::size_t k = 0; k < 2 * n; ++k) {
        u[k] += dt * v[k];
        if (!(std::fabs(u[k]) < largest)) largest = std::fabs(u[k]);
      }
    }
    return std::isfinite(largest) ? largest / 1e-6 : HUGE_VAL;
  };
  CHECK(growth(0.97 * limit) < 100.0);
  CHECK(growth(1.03 * limit) > 1e6);
}
