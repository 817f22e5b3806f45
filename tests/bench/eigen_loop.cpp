// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/eigen_loop.hpp"

#include <algorithm>
#include <cmath>

#include "shoal/smoothing_kernel.hpp"

namespace shoal::bench {

void eigen_loop(EigenFluid& fluid, const kernel::NeighbourList& list, double smoothing_length,
                const Constants& constants) {
  const WendlandC2<3> kernel(smoothing_length);
  const double c = constants.sound_speed, impedance = constants.reference_density * c,
               per_impedance = 1.0 / impedance;
  for (std::size_t i = 0; i < fluid.position.size(); ++i) {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    double divergence = 0.0;
    const std::uint32_t* row = list.indices() + list.offsets()[i];
    for (std::uint32_t m = 0; m < list.counts()[i]; ++m) {
      const std::uint32_t j = row[m];
      const Eigen::Vector3d r_ij = fluid.position[i] - fluid.position[j];
      const double r = r_ij.norm();
      const double weight = constants.mass / fluid.density[j] * kernel.dw_over_r(r);
      const double v_r = (fluid.velocity[i] - fluid.velocity[j]).dot(r_ij);
      const double jump = -v_r / r;
      const double beta = std::min(1.0, std::max(0.0, (3.0 / c) * jump));
      const double p_star = fluid.pressure[i] + fluid.pressure[j] + impedance * beta * jump;
      force += (weight * p_star) * r_ij;
      divergence += weight * (v_r + per_impedance * r * (fluid.pressure[i] - fluid.pressure[j]));
    }
    fluid.acceleration[i] = (-1.0 / fluid.density[i]) * force;
    fluid.density_rate[i] = fluid.density[i] * divergence;
  }
}

}  // namespace shoal::bench
