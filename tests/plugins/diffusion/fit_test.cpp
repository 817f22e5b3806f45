// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The accurate scheme is exact for quadratic fields: inside, and at surfaces of every kind.
#include <doctest/doctest.h>

#include "fit.hpp"
#include "particles.hpp"
#include "surface.hpp"

using namespace shoal;
using namespace shoal::diffusion;
using namespace shoal::diffusion::test;

namespace {

constexpr double dx = 0.1, h = 0.13;

// c = g . x + x . H . x / 2 + 2
struct QuadraticField {
  std::vector<double> g, H;
  std::size_t d;

  explicit QuadraticField(int dimensions) : d(static_cast<std::size_t>(dimensions)) {
    g = {0.7, -0.4, 1.1};
    H = {1.0, 0.4, -0.6, 0.4, -2.0, 0.8, -0.6, 0.8, 0.5};
  }
  double value(const double* x) const {
    double sum = 2.0;
    for (std::size_t a = 0; a < d; ++a) {
      sum += g[a] * x[a];
      for (std::size_t b = 0; b < d; ++b) sum += 0.5 * H[a * 3 + b] * x[a] * x[b];
    }
    return sum;
  }
  double gradient(const double* x, std::size_t a) const {
    double sum = g[a];
    for (std::size_t b = 0; b < d; ++b) sum += H[a * 3 + b] * x[b];
    return sum;
  }
};

// K = k(x) T: k linear in x, so that div(K grad c) has both parts.
double k_of(const double* x) { return 2.0 + 0.3 * x[0] - 0.2 * x[1]; }
double tensor(std::size_t d, std::size_t a, std::size_t b) {
  static const double t2[4] = {3.0, 0.7, 0.7, 1.0}, t3[9] = {3.0, 0.7, 0.2, 0.7, 1.0, -0.3, 0.2, -0.3, 2.0};
  return d == 2 ? t2[a * 2 + b] : t3[a * 3 + b];
}

double divergence(const QuadraticField& c, const double* x, bool varies) {
  const double slope[3] = {varies ? 0.3 : 0.0, varies ? -0.2 : 0.0, 0.0};
  double sum = 0;
  for (std::size_t a = 0; a < c.d; ++a)
    for (std::size_t b = 0; b < c.d; ++b)
      sum += tensor(c.d, a, b) * ((varies ? k_of(x) : 1.0) * c.H[a * 3 + b] + slope[a] * c.gradient(x, b));
  return sum;
}

void set_fields(Body& body, const QuadraticField& c, bool varies) {
  const std::size_t d = c.d;
  const auto& x = body["position"];
  body.set("volume", std::pow(dx, static_cast<double>(d)));
  body.set_each("c", 1, [&](std::size_t i, std::size_t) { return c.value(&x[i * d]); });
  body.set_each("c_conductivity", d * d, [&](std::size_t i, std::size_t ab) {
    return (varies ? k_of(&x[i * d]) : 1.0) * tensor(d, ab / d, ab % d);
  });
}

// The surface of the unit cube: faces of lower x have condition 2, of upper x 3, of upper y 4, others 5.
void set_surface(Body& body) {
  const auto d = static_cast<std::size_t>(body.dimensions());
  std::vector<double> normal(body.size() * d), distance(body.size()), surface(body.size());
  for (std::size_t i = 0; i < body.size(); ++i) {
    const double* x = &body["position"][i * d];
    double nearest = 1.0;
    std::size_t axis = 0;
    bool upper = false;
    for (std::size_t a = 0; a < d; ++a)
      for (const bool high : {false, true})
        if ((high ? 1.0 - x[a] : x[a]) < nearest) nearest = high ? 1.0 - x[a] : x[a], axis = a, upper = high;
    normal[i * d + axis] = upper ? 1.0 : -1.0;
    distance[i] = -nearest;
    if (nearest < dx) surface[i] = axis == 0 ? (upper ? 3.0 : 2.0) : axis == 1 && upper ? 4.0 : 5.0;
  }
  body["surface_normal"] = normal;
  body["signed_distance"] = distance;
  body["c_surface"] = surface;
}

std::vector<Condition> conditions() {
  std::vector<Condition> all(4);
  all[0].a = 1, all[0].b = 0;    // value
  all[1].a = 0, all[1].b = 1;    // flux
  all[2].a = 7.5, all[2].b = 1;  // convection
  all[3].a = 0, all[3].b = 1;    // flux
  return all;
}

// g of A c + B n . K grad c at the surface point of each particle
void set_data(Body& body, const QuadraticField& c) {
  const std::size_t d = c.d;
  body.set_each("c_surface_data", 1, [&](std::size_t i, std::size_t) {
    const int number = static_cast<int>(body["c_surface"][i]);
    if (number < 2) return 0.0;
    std::vector<double> x(d);
    for (std::size_t a = 0; a < d; ++a)
      x[a] = body["position"][i * d + a] - body["signed_distance"][i] * body["surface_normal"][i * d + a];
    const Condition condition = conditions()[static_cast<std::size_t>(number - 2)];
    double flux = 0;
    for (std::size_t a = 0; a < d; ++a)
      for (std::size_t b = 0; b < d; ++b)
        flux += body["surface_normal"][i * d + a] * tensor(d, a, b) * c.gradient(x.data(), b);
    return condition.a * c.value(x.data()) + condition.b * flux;
  });
}

std::shared_ptr<Stencil> new_stencil() {
  auto stencil = std::make_shared<Stencil>();
  stencil->motions.push_back(std::make_shared<Motion>());
  stencil->seen = {7};
  return stencil;
}

}  // namespace

TEST_CASE("div(K grad c) is exact inside, on disordered particles: quadratic c, or linear c and linear K") {
  const std::pair<int, bool> choices[] = {{2, false}, {3, false}, {2, true}, {3, true}};
  for (const auto& [d, varies] : choices) {
    const int n = d == 2 ? 10 : 8;
    Body body(d, lattice(d, dx, n, 0.25));
    QuadraticField c(d);
    if (varies) c.H.assign(9, 0.0);
    set_fields(body, c, varies);
    const auto stencil = new_stencil();
    FitWeights weights;
    weights.set("c", false, stencil);
    weights.capacity = 2.0;
    const Setup setup{.smoothing_length = h, .spacing = dx};
    testing::run(weights, body, {&body}, setup);
    for (const bool scalar : {false, true}) {
      body.set("c_rate", 0.25);
      ApplyStencil apply;
      apply.set("c", stencil);
      testing::run(apply, body, {&body}, {.smoothing_length = h, .spacing = dx, .scalar = scalar});
      int inside = 0;
      for (std::size_t i = 0; i < body.size(); ++i) {
        const double* x = &body["position"][i * c.d];
        bool interior = true;
        for (std::size_t a = 0; a < c.d; ++a) interior &= x[a] > 2 * h && x[a] < n * dx - 2 * h;
        if (!interior) continue;
        ++inside;
        CHECK(body["c_rate"][i] == doctest::Approx(0.25 + divergence(c, x, varies) / 2.0).epsilon(1e-9));
      }
      CHECK(inside > 5);
    }
  }
}

TEST_CASE("it is exact up to surfaces with given value, flux and convection, and in their corners") {
  for (const int d : {2, 3}) {
    Body body(d, lattice(d, dx, 10, d == 2 ? 0.2 : 0.1));
    const QuadraticField c(d);
    set_fields(body, c, false);
    set_surface(body);
    set_data(body, c);
    const auto stencil = new_stencil();
    FitWeights weights;
    weights.set("c", false, stencil);
    weights.set_surface("c", conditions());
    const Setup setup{.smoothing_length = h, .spacing = dx};
    testing::run(weights, body, {&body}, setup);
    body.set("c_rate", 0.0);
    ApplyStencil pairs;
    pairs.set("c", stencil);
    testing::run(pairs, body, {&body}, setup);
    ApplySurface surface;
    surface.set("c", stencil);
    testing::run(surface, body, {&body}, setup);
    for (std::size_t i = 0; i < body.size(); ++i)
      CHECK(body["c_rate"][i] ==
            doctest::Approx(divergence(c, &body["position"][i * c.d], false)).epsilon(1e-8));
    CHECK(stencil->spectral_radius > 0.0);
  }
}

TEST_CASE("a particle with too few neighbours for a fit has the row of the conservative scheme") {
  Body body(2, {0.0, 0.0, 0.1, 0.0, 0.0, 0.1});
  body.set("volume", 0.01);
  body.set("c_conductivity", 1.0);
  const auto fitted = new_stencil(), pairwise = new_stencil();
  FitWeights fit;
  fit.set("c", true, fitted);
  PairwiseWeights pairs;
  pairs.set("c", true, pairwise);
  const Setup setup{.smoothing_length = h, .spacing = dx};
  testing::run(fit, body, {&body}, setup);
  testing::run(pairs, body, {&body}, setup);
  CHECK(fitted->weights[0][0] > 0.0);
  CHECK(fitted->weights[0] == pairwise->weights[0]);
}

namespace {

// Two halves of the unit square side by side, with k = 1 and k = `jump`; all that belongs to the right one is moved there.
struct Halves {
  Body left{2, lattice(2, dx, 10)}, right{2, lattice(2, dx, 10)};

  explicit Halves(double jump) {
    for (Body* body : {&left, &right}) {
      set_surface(*body);
      body->set("volume", dx * dx);
      body->set("c_conductivity", body == &left ? 1.0 : jump);
    }
    // Faces of value 0 and 1 at x = 0 and 2, the interface at x = 1, insulated at y = 0 and 1.
    for (std::size_t i = 0; i < left.size(); ++i) {
      const double in_left = left["c_surface"][i], in_right = right["c_surface"][i];
      left["c_surface"][i] = in_left == 2.0 ? 2.0 : in_left == 3.0 ? -1.0 : in_left > 0.0 ? 1.0 : 0.0;
      right["c_surface"][i] = in_right == 3.0 ? 2.0 : in_right == 2.0 ? -1.0 : in_right > 0.0 ? 1.0 : 0.0;
    }
    for (std::size_t i = 0; i < right.size(); ++i) right["position"][2 * i] += 1.0;
  }
};

std::vector<double> rates(Body& own, Body& other, double data) {
  const auto stencil = new_stencil();
  stencil->motions.push_back(std::make_shared<Motion>());
  FitWeights weights;
  weights.set("c", true, stencil);
  std::vector<Condition> value(1);
  value[0].a = 1, value[0].b = 0;
  weights.set_surface("c", value);
  weights.capacities = {1.0, 1.0};
  const Setup setup{.smoothing_length = h, .spacing = dx};
  testing::run(weights, own, {&own, &other}, setup);
  own.set("c_rate", 0.0);
  own.set("c_surface_data", data);
  ApplyStencil pairs;
  pairs.set("c", stencil);
  testing::run(pairs, own, {&own, &other}, setup);
  ApplySurface surface;
  surface.set("c", stencil);
  testing::run(surface, own, {&own}, setup);
  return own["c_rate"];
}

}  // namespace

TEST_CASE("the steady state across a jump of a million stays what it is: the flux is continuous") {
  for (const double jump : {1.0, 1e6, 1e-6}) {
    Halves both(jump);
    // From 0 at x = 0 to 1 at x = 2 with the flux q everywhere
    const double q = 1.0 / (1.0 + 1.0 / jump);
    both.left.set_each("c", 1, [&](std::size_t i, std::size_t) { return q * both.left["position"][2 * i]; });
    both.right.set_each("c", 1, [&](std::size_t i, std::size_t) {
      return 1.0 - q / jump * (2.0 - both.right["position"][2 * i]);
    });
    // Rates over those of a flux that changes by q from one particle to the next
    const double scale = q / dx;
    for (const double rate : rates(both.left, both.right, 0.0)) CHECK(std::abs(rate) < 1e-6 * scale);
    for (const double rate : rates(both.right, both.left, 1.0)) CHECK(std::abs(rate) < 1e-6 * scale);
  }
}

TEST_CASE(
    "monotone weights are never negative; at ratio 10 they are exact for quadratic fields, at 1000 for "
    "linear ones") {
  for (const auto& [ratio, jitter] : {std::pair{10.0, 0.0}, {10.0, 0.1}, {1000.0, 0.0}, {1000.0, 0.1}}) {
    Body body(2, lattice(2, dx, 12, jitter));
    const double c30 = std::cos(std::numbers::pi / 6), s30 = 0.5, across = 1.0 / ratio;
    const double K[4] = {across + (1 - across) * c30 * c30, (1 - across) * c30 * s30,
                         (1 - across) * c30 * s30, across + (1 - across) * s30 * s30};
    QuadraticField c(2);
    if (ratio > 100) c.H.assign(9, 0.0);
    body.set("volume", dx * dx);
    body.set_each("c_conductivity", 4, [&](std::size_t, std::size_t ab) { return K[ab]; });
    body.set_each("c", 1, [&](std::size_t i, std::size_t) { return c.value(&body["position"][2 * i]); });
    const auto stencil = new_stencil();
    FitWeights weights;
    weights.monotone = true;
    weights.set("c", false, stencil);
    testing::run(weights, body, {&body}, {.smoothing_length = 1.3 * h, .spacing = dx});
    for (const double l : stencil->weights[0]) CHECK(l >= 0.0);
    ApplyStencil apply;
    apply.set("c", stencil);
    testing::run(apply, body, {&body}, {.smoothing_length = 1.3 * h, .spacing = dx});
    double exact = 0;
    for (std::size_t a = 0; a < 2; ++a)
      for (std::size_t b = 0; b < 2; ++b) exact += K[2 * a + b] * c.H[3 * a + b];
    int inside = 0;
    for (std::size_t i = 0; i < body.size(); ++i) {
      const double x = body["position"][2 * i], y = body["position"][2 * i + 1];
      if (std::min({x, y, 1.2 - x, 1.2 - y}) < 2.6 * h) continue;
      ++inside;
      CHECK(std::abs(body["c_rate"][i] - exact) < 1e-3 * (std::abs(exact) + 1.0));
    }
    CHECK(inside > 5);
  }
}
