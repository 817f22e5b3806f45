// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Bodies for tests of the fluid's operators, and the smoothing kernel once more, written plainly.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "shoal/testing.hpp"

namespace shoal::fluid::test {

using shoal::testing::Body;
using shoal::testing::Setup;

// Lattice points (k + 1/2) dx inside [lower, upper), moved by up to `jitter` dx in each direction.
inline std::vector<double> lattice(int dimensions, double dx, std::vector<double> lower,
                                   std::vector<double> upper, double jitter = 0.0) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-jitter * dx, jitter * dx);
  const auto d = static_cast<std::size_t>(dimensions);
  std::vector<long> n(3, 1), k(3, 0);
  for (std::size_t a = 0; a < d; ++a) n[a] = std::lround((upper[a] - lower[a]) / dx);
  std::vector<double> points;
  for (k[2] = 0; k[2] < n[2]; ++k[2])
    for (k[1] = 0; k[1] < n[1]; ++k[1])
      for (k[0] = 0; k[0] < n[0]; ++k[0])
        for (std::size_t a = 0; a < d; ++a)
          points.push_back(lower[a] + (static_cast<double>(k[a]) + 0.5) * dx + uniform(random));
  return points;
}

// Wendland C2 (Wendland 1995) and its derivative, as on paper.
inline double plain_w(int dimensions, double h, double r) {
  const double q = r / h, pi = std::numbers::pi;
  const double a = dimensions == 2 ? 7.0 / (4.0 * pi * h * h) : 21.0 / (16.0 * pi * h * h * h);
  return q < 2.0 ? a * std::pow(1.0 - q / 2.0, 4) * (1.0 + 2.0 * q) : 0.0;
}
inline double plain_dw(int dimensions, double h, double r) {
  const double q = r / h, pi = std::numbers::pi;
  const double a = dimensions == 2 ? 7.0 / (4.0 * pi * h * h) : 21.0 / (16.0 * pi * h * h * h);
  return q < 2.0 ? a / h * (-5.0 * q) * std::pow(1.0 - q / 2.0, 3) : 0.0;
}

// Masses that go with the volumes and densities.
inline void set_masses(Body& body) {
  auto &volume = body["volume"], &density = body["density"];
  body.set_each("mass", 1, [&](std::size_t i, std::size_t) { return volume[i] * density[i]; });
}

// For every i, calls visit(i, j, r, e_ij) for all neighbours j.
inline void for_all_pairs(
    Body& own, Body& other, double cutoff,
    const std::function<void(std::size_t, std::size_t, double, const std::vector<double>&)>& visit) {
  const auto d = static_cast<std::size_t>(own.dimensions());
  const auto &x = own["position"], &y = other["position"];
  for (std::size_t i = 0; i < own.size(); ++i)
    for (std::size_t j = 0; j < other.size(); ++j) {
      if (&own == &other && i == j) continue;
      std::vector<double> e(d);
      double squared = 0;
      for (std::size_t a = 0; a < d; ++a) {
        e[a] = x[i * d + a] - y[j * d + a];
        squared += e[a] * e[a];
      }
      const double r = std::sqrt(squared);
      if (r >= cutoff) continue;
      for (double& component : e) component /= r;
      visit(i, j, r, e);
    }
}

}  // namespace shoal::fluid::test
