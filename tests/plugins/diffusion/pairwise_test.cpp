// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The conservative scheme against plain double loops.
#include <doctest/doctest.h>

#include "pairwise.hpp"
#include "particles.hpp"

using namespace shoal;
using namespace shoal::diffusion;
using namespace shoal::diffusion::test;

namespace {

constexpr double dx = 0.1, h = 0.13;

// The weights and then the rate of field c of `own`, of itself and `others`.
void rate(Body& own, std::vector<Body*> bodies, bool isotropic, double capacity, bool scalar,
          bool corrected = false) {
  const auto stencil = std::make_shared<Stencil>();
  for (std::size_t k = 0; k < bodies.size(); ++k) stencil->motions.push_back(std::make_shared<Motion>());
  for (Body* body : bodies) body->set("volume", std::pow(dx, own.dimensions()));
  stencil->seen = {7};
  PairwiseWeights weights;
  weights.set("c", isotropic, stencil);
  weights.capacity = capacity;
  if (corrected) weights.correct_gradient();
  const Setup setup{.smoothing_length = h, .spacing = dx, .scalar = scalar};
  testing::run(weights, own, bodies, setup);
  ApplyStencil apply;
  apply.set("c", stencil);
  testing::run(apply, own, bodies, setup);
}

}  // namespace

TEST_CASE("isotropic rates are the plain double sum, of several bodies, with packs and without") {
  for (const int d : {2, 3})
    for (const bool scalar : {false, true}) {
      Body own(d, lattice(d, dx, 6, 0.3)), other(d, lattice(d, dx, 6, 0.3));
      for (double& x : other["position"]) x += 0.25;
      own.set_each("c", 1, [](std::size_t i, std::size_t) { return std::sin(static_cast<double>(i)); });
      other.set_each("c", 1, [](std::size_t i, std::size_t) { return std::cos(static_cast<double>(i)); });
      own.set_each("c_conductivity", 1,
                   [](std::size_t i, std::size_t) { return 1.0 + static_cast<double>(i % 7); });
      other.set("c_conductivity", 1e6);
      own["c_rate"].assign(own.size(), 0.5);
      rate(own, {&own, &other}, true, 4.0, scalar);
      double slope = 0;
      for (int a = -3; a <= 3; ++a)
        for (int b = -3; b <= 3; ++b)
          for (int c = d == 3 ? -3 : 0; c <= (d == 3 ? 3 : 0); ++c) {
            const double r = dx * std::sqrt(a * a + b * b + c * c);
            if (r > 0) slope -= std::pow(dx, d) * plain_dw(d, h, r) * a * a * dx * dx / r;
          }
      for (std::size_t i = 0; i < own.size(); ++i) {
        double sum = 0.5;
        for (Body* body : {&own, &other})
          for (std::size_t j = 0; j < body->size(); ++j) {
            if (body == &own && i == j) continue;
            const double r = length(difference(own, i, *body, j));
            const double k_i = own["c_conductivity"][i], k_j = (*body)["c_conductivity"][j];
            sum += 2.0 / 4.0 * std::pow(dx, d) / slope * 2.0 * k_i * k_j / (k_i + k_j) *
                   (own["c"][i] - (*body)["c"][j]) * plain_dw(d, h, r) / r;
          }
        CHECK(own["c_rate"][i] == doctest::Approx(sum).epsilon(1e-11));
      }
    }
}

TEST_CASE("on a lattice the second derivatives of any tensor are exact, and content is kept everywhere") {
  for (const int d : {2, 3}) {
    const auto n = static_cast<std::size_t>(d);
    const std::vector<double> k = d == 2 ? std::vector<double>{3.0, 0.7, 0.7, 1.0}
                                         : std::vector<double>{3.0, 0.7, 0.2, 0.7, 1.0, -0.3, 0.2, -0.3, 2.0};
    Body body(d, lattice(d, dx, 9));
    body.set_each("c_conductivity", n * n, [&](std::size_t, std::size_t c) { return k[c]; });
    // c = x.H.x / 2 + x has K : H
    const double H[3][3] = {{1.0, 0.4, -0.6}, {0.4, -2.0, 0.8}, {-0.6, 0.8, 0.5}};
    body.set_each("c", 1, [&](std::size_t i, std::size_t) {
      const double* x = &body["position"][i * n];
      double sum = x[0];
      for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < n; ++b) sum += 0.5 * H[a][b] * x[a] * x[b];
      return sum;
    });
    rate(body, {&body}, false, 1.0, false);
    double exact = 0, total = 0;
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = 0; b < n; ++b) exact += k[a * n + b] * H[a][b];
    int inside = 0;
    for (std::size_t i = 0; i < body.size(); ++i) {
      total += body["c_rate"][i];
      bool interior = true;
      for (std::size_t a = 0; a < n; ++a)
        interior &= std::abs(body["position"][i * n + a] - 4.5 * dx) < 4.6 * dx - 2 * h;
      if (!interior) continue;
      ++inside;
      CHECK(body["c_rate"][i] == doctest::Approx(exact).epsilon(1e-10));
    }
    CHECK(inside > 0);
    CHECK(std::abs(total) < 1e-9);
  }
}

TEST_CASE(
    "what two bodies exchange is kept, whatever their capacities, with correction of the gradient too") {
  for (const bool corrected : {false, true}) {
    Body left(2, lattice(2, dx, 8, 0.2)), right(2, lattice(2, dx, 8, 0.2));
    for (std::size_t i = 0; i < right.size(); ++i) right["position"][2 * i] += 8 * dx;
    left.set_each("c", 1, [](std::size_t i, std::size_t) { return std::sin(static_cast<double>(i)); });
    right.set_each("c", 1, [](std::size_t i, std::size_t) { return 3.0 + std::cos(static_cast<double>(i)); });
    left.set("c_conductivity", 1.0);
    right.set("c_conductivity", 50.0);
    double total = 0, size = 0;
    const double capacities[2] = {4.0, 0.5};
    if (corrected)
      for (auto [own, other] : {std::pair{&left, &right}, {&right, &left}}) {
        own->set("volume", dx * dx);
        other->set("volume", dx * dx);
        GradientCorrection correction;
        testing::run(correction, *own, {own, other}, {.smoothing_length = h, .spacing = dx});
      }
    for (const int side : {0, 1}) {
      Body& own = side == 0 ? left : right;
      Body& other = side == 0 ? right : left;
      own["c_rate"].clear();
      rate(own, {&own, &other}, true, capacities[side], false, corrected);
      for (std::size_t i = 0; i < own.size(); ++i) {
        total += capacities[side] * own["c_rate"][i];
        size += capacities[side] * std::abs(own["c_rate"][i]);
      }
    }
    CHECK(std::abs(total) < 1e-12 * size);
  }
}

TEST_CASE("the correction of the gradient is the inverse of its first moments") {
  for (const int d : {2, 3}) {
    Body body(d, lattice(d, dx, 6, 0.25));
    body.set("volume", std::pow(dx, d));
    GradientCorrection op;
    testing::run(op, body, {&body}, {.smoothing_length = h, .spacing = dx});
    const auto n = static_cast<std::size_t>(d);
    for (std::size_t i = 0; i < body.size(); ++i) {
      std::vector<double> moments(n * n);
      for (std::size_t j = 0; j < body.size(); ++j) {
        if (i == j) continue;
        const auto x = difference(body, i, body, j);
        for (std::size_t a = 0; a < n; ++a)
          for (std::size_t b = 0; b < n; ++b)
            moments[a * n + b] -= std::pow(dx, d) * plain_dw(d, h, length(x)) / length(x) * x[a] * x[b];
      }
      for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < n; ++b) {
          double product = 0;
          for (std::size_t c = 0; c < n; ++c)
            product += moments[a * n + c] * body["gradient_correction"][i * n * n + c * n + b];
          CHECK(product == doctest::Approx(a == b ? 1.0 : 0.0).epsilon(1e-10));
        }
    }
  }
}
