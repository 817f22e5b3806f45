// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The largest eigenvalue that steps are chosen by, against the growth in a thousand multiplications by the dense matrix.
#include <doctest/doctest.h>

#include <cstdio>
#include <utility>

#include "fit.hpp"
#include "particles.hpp"

using namespace shoal;
using namespace shoal::diffusion;
using namespace shoal::diffusion::test;

namespace {

constexpr double dx = 0.1;

struct Operator {
  int dimensions, n;
  double jitter, across;  // of K across the fibres, at 30 degrees to x
  bool fit, jump = false;
};

// Column after column of the operator as a dense matrix.
std::vector<std::vector<double>> columns(Body& body, const std::shared_ptr<const Stencil>& stencil,
                                         const Setup& setup) {
  std::vector<std::vector<double>> all;
  ApplyStencil apply;
  apply.set("c", stencil);
  for (std::size_t j = 0; j < body.size(); ++j) {
    body.set("c", 0.0);
    body.set("c_rate", 0.0);
    body["c"][j] = 1.0;
    testing::run(apply, body, {&body}, setup);
    all.push_back(body["c_rate"]);
  }
  return all;
}

// Mean growth of a vector in the second half of 1200 multiplications.
double growth(const std::vector<std::vector<double>>& columns) {
  std::vector<double> c(columns.size()), next(columns.size());
  for (std::size_t i = 0; i < c.size(); ++i) c[i] = std::sin(static_cast<double>(7 * i * i + 1));
  double sum = 0;
  for (int k = 0; k < 1200; ++k) {
    std::fill(next.begin(), next.end(), 0.0);
    for (std::size_t j = 0; j < c.size(); ++j)
      for (std::size_t i = 0; i < c.size(); ++i) next[i] += columns[j][i] * c[j];
    const double factor = length(next);
    for (std::size_t i = 0; i < c.size(); ++i) c[i] = next[i] / factor;
    if (k >= 600) sum += std::log(factor);
  }
  return std::exp(sum / 600);
}

// Insulated faces of a box, without which the fit would extrapolate and have modes that grow.
void set_surface(Body& body, double size) {
  const auto d = static_cast<std::size_t>(body.dimensions());
  std::vector<double> normal(body.size() * d), distance(body.size()), surface(body.size());
  for (std::size_t i = 0; i < body.size(); ++i) {
    const double* x = &body["position"][i * d];
    double nearest = size;
    std::size_t of = 0;
    for (std::size_t a = 0; a < 2 * d; ++a) {
      const double depth = a % 2 == 0 ? x[a / 2] : size - x[a / 2];
      if (depth < nearest) nearest = depth, of = a;
    }
    normal[i * d + of / 2] = of % 2 == 0 ? -1.0 : 1.0;
    distance[i] = -nearest;
    surface[i] = nearest < dx ? 1.0 : 0.0;
  }
  body["surface_normal"] = normal;
  body["signed_distance"] = distance;
  body["c_surface"] = surface;
}

// What the weights say over what is true.
double estimate(const Operator& of) {
  const auto d = static_cast<std::size_t>(of.dimensions);
  Body body(of.dimensions, lattice(of.dimensions, dx, of.n, of.jitter));
  body.set("volume", std::pow(dx, of.dimensions));
  const double f[3] = {std::sqrt(0.75), 0.5, 0.0};
  body.set_each("c_conductivity", d * d, [&](std::size_t i, std::size_t ab) {
    const double k = of.jump && body["position"][i * d] > 0.5 * of.n * dx ? 100.0 : 1.0;
    return k * ((ab / d == ab % d ? of.across : 0.0) + (1.0 - of.across) * f[ab / d] * f[ab % d]);
  });
  set_surface(body, of.n * dx);
  auto stencil = std::make_shared<Stencil>();
  stencil->motions.push_back(std::make_shared<Motion>());
  stencil->seen = {7};
  const Setup setup{.smoothing_length = 1.3 * dx, .spacing = dx};
  const auto run = [&]<class Weights>(std::in_place_type_t<Weights>) {
    Weights weights;
    weights.set("c", false, stencil);
    if (of.fit) weights.set_surface("c", {});
    testing::run(weights, body, {&body}, setup);
  };
  of.fit ? run(std::in_place_type<FitWeights>) : run(std::in_place_type<PairwiseWeights>);
  return stencil->spectral_radius / growth(columns(body, stencil, setup));
}

}  // namespace

TEST_CASE("the largest eigenvalue is overestimated, by a few per cent") {
  for (const bool fit : {false, true})
    for (const Operator& of :
         {Operator{2, 20, 0.0, 1.0, fit}, Operator{2, 20, 0.2, 1.0, fit}, Operator{2, 20, 0.2, 0.1, fit},
          Operator{3, 7, 0.2, 1.0, fit}, Operator{2, 20, 0.1, 0.1, fit, true}}) {
      const double ratio = estimate(of);
      std::printf("%d dimensions, jitter %.1f, across %.1f, %s%s: %.4f\n", of.dimensions, of.jitter,
                  of.across, of.fit ? "accurate" : "conservative", of.jump ? ", jump by 100" : "", ratio);
      CHECK(ratio >= 1.0);
      CHECK(ratio <= 1.05);
    }
}
