// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Viscous acceleration along the line of two particles (Monaghan, Gingold 1983; with this factor Monaghan 2005, eq. 8.9):
//   dv_i/dt = 2 (D + 2) (eta / rho_i) sum_j V_j (v_ij.r_ij) / (r^2 + 0.01 h^2) grad W_ij
// Pairs exchange opposite central forces: angular momentum is kept to rounding, which the form of viscosity.hpp does not
// do. It holds a bulk viscosity of 5/3 eta, nothing to an incompressible flow. At no-slip walls velocities are continued as
// in viscosity.hpp. Evaluated once in an advection step; stable for dt <= 0.125 h^2 / nu of that step.
#pragma once

#include "shoal/pair_operator.hpp"

#include "viscosity.hpp"

namespace shoal::fluid {

struct CentralViscousForce : PairOperator<CentralViscousForce> {
  In<Vector> velocity{"velocity"};
  In<Scalar> volume{"volume"};
  In<Scalar> density{"density", own_only};
  Accumulate<Vector> acceleration{"acceleration"};

  double viscosity = 0;          // Pa s
  double reference_density = 0;  // kg/m3
  double gradient_scale = 1;     // 1 / slope of lattice_sums()

  auto pair(const auto& p) const {
    const auto along = dot(p.i(velocity) - p.j(velocity), p.r_ij());
    return (p.j(volume) * p.dW_over_r() * along / (p.r() * p.r() + 0.01 * p.h() * p.h())) * p.r_ij();
  }
  void particle(auto i, auto sum) const {
    acceleration[i] += (2.0 * (i.dimensions + 2) * gradient_scale * viscosity / density[i]) * sum;
  }
  double time_step(double h) const { return 0.125 * h * h * reference_density / viscosity; }
};

// The share of the no-slip walls.
struct WallCentralViscousForce : PairOperator<WallCentralViscousForce> {
  static constexpr bool skips_lonely = true;

  In<Vector> velocity{"velocity", own_only};
  In<Scalar> density{"density", own_only};
  In<Vector> wall_velocity{"velocity", neighbours_only};
  In<Vector> wall_normal{"normal", neighbours_only};
  In<Scalar> wall_distance{"signed_distance", neighbours_only};
  In<Scalar> wall_volume{"volume", neighbours_only};
  Accumulate<Vector> acceleration{"acceleration"};

  double viscosity = 0;       // Pa s
  double gradient_scale = 1;  // 1 / slope of lattice_sums()

  auto pair(const auto& p) const {
    const auto across = abs(dot(p.j(wall_normal), p.r_ij()));
    const auto along = dot(p.i(velocity) - p.j(wall_velocity), p.r_ij());
    return (p.j(wall_volume) * p.dW_over_r() * no_slip_factor(across, p.j(wall_distance)) * along /
            (p.r() * p.r() + 0.01 * p.h() * p.h())) *
           p.r_ij();
  }
  void particle(auto i, auto sum) const {
    acceleration[i] += (2.0 * (i.dimensions + 2) * gradient_scale * viscosity / density[i]) * sum;
  }
};

}  // namespace shoal::fluid
