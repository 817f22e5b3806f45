// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The physics of OnePass as codes of this field usually write it: vectors of Eigen::Vector3d and a loop over the
// neighbours of a particle, one after the other.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "kernel/neighbours/neighbour_list.hpp"
#include "tests/bench/one_pass.hpp"

namespace shoal::bench {

struct EigenFluid {
  std::vector<Eigen::Vector3d> position, velocity, acceleration;
  std::vector<double> density, pressure, density_rate;
};

void eigen_loop(EigenFluid& fluid, const kernel::NeighbourList& list, double smoothing_length,
                const Constants& constants);

}  // namespace shoal::bench
