// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Bodies for tests of the diffusion's operators, and the smoothing kernel once more, written plainly.
#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "shoal/testing.hpp"

namespace shoal::diffusion::test {

using shoal::testing::Body;
using shoal::testing::Setup;

// Points (k + 1/2) dx of a box of n points in each direction, moved by up to `jitter` dx.
inline std::vector<double> lattice(int dimensions, double dx, int n, double jitter = 0.0) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(-jitter * dx, jitter * dx);
  std::vector<double> points;
  for (int z = 0; z < (dimensions == 3 ? n : 1); ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const int k[3] = {x, y, z};
        for (int a = 0; a < dimensions; ++a) points.push_back((k[a] + 0.5) * dx + uniform(random));
      }
  return points;
}

// Wendland C2: W'(r), as on paper (Wendland 1995).
inline double plain_dw(int dimensions, double h, double r) {
  const double q = r / h, pi = std::numbers::pi;
  const double a = dimensions == 2 ? 7.0 / (4.0 * pi * h * h) : 21.0 / (16.0 * pi * h * h * h);
  return q < 2.0 ? a / h * (-5.0 * q) * std::pow(1.0 - q / 2.0, 3) : 0.0;
}

// r_i - r_j
inline std::vector<double> difference(Body& own, std::size_t i, Body& other, std::size_t j) {
  const auto d = static_cast<std::size_t>(own.dimensions());
  std::vector<double> x(d);
  for (std::size_t a = 0; a < d; ++a) x[a] = own["position"][i * d + a] - other["position"][j * d + a];
  return x;
}
inline double length(const std::vector<double>& x) {
  double squared = 0;
  for (const double component : x) squared += component * component;
  return std::sqrt(squared);
}

}  // namespace shoal::diffusion::test
