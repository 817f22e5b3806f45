// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A wave of a reaction along a line of nodes: what a plane wave on a lattice of particles is, if the sums over the
// particles of a plane are gathered into weights l_n of the nodes n apart,
//   dy_i/dt = sum_n l_n (y_(i+n) + y_(i-n) - 2 y_i) + reaction                  (first variable; l_n in 1/s)
// with the splitting and the integrator of a run.
#pragma once

#include <vector>

#include "integrator.hpp"

namespace shoal::diffusion {

struct Cable {
  std::vector<double> weights;  // l_1, l_2, ...; 1/s
  double spacing = 0;           // m
  double step = 0;              // s, of the splitting
  std::size_t nodes = 0;
  double longest_time = 0;  // s, when to give up
};

// Speed of the wave that starts from the excited first sixth of the line, between 55 % and 90 % of it, m/s; 0 if it does
// not get there.
double wave_speed(const ReactionIntegrator& reaction, const Cable& cable);

// Weights of the second difference, D / dx^2.
std::vector<double> second_difference(double diffusivity, double spacing);

}  // namespace shoal::diffusion
