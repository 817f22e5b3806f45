// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What is measured: momentum and continuity with the low-dissipation Riemann solver (Zhang, Hu, Adams 2017) in one
// pass over position, velocity, density and pressure,
//   dv_i/dt   = -(2/rho_i) sum_j V_j P* W' e_ij,        P* = (p_i + p_j)/2 + beta rho0 c (u_L - u_R)/2
//   drho_i/dt =  2 rho_i sum_j V_j (v_i - v*).e_ij W',  v*.e_ij = (v_i + v_j).e_ij/2 - (p_i - p_j)/(2 rho0 c)
//   u_L - u_R = -(v_i - v_j).e_ij,  beta = min(1, max(0, 3 (u_L - u_R)/c)),  V_j = m/rho_j
#pragma once

#include "shoal/pair_operator.hpp"

namespace shoal::bench {

struct Constants {
  double mass = 0;               // kg
  double reference_density = 0;  // kg/m3
  double sound_speed = 0;        // m/s
};

struct OnePass : PairOperator<OnePass> {
  In<Vector> velocity{"velocity"};
  In<Scalar> density{"density"};
  In<Scalar> pressure{"pressure"};
  Out<Vector> pressure_acceleration{"pressure_acceleration"};
  Out<Scalar> density_rate{"density_rate"};

  Constants constants;

  auto pair(const auto& p) const {
    const double impedance = constants.reference_density * constants.sound_speed,
                 per_impedance = 1.0 / impedance;
    const auto weight = constants.mass * reciprocal(p.j(density)) * p.dW_over_r();
    const auto v_r = dot(p.i(velocity) - p.j(velocity), p.r_ij());
    const auto jump = -v_r * p.per_r();
    const auto beta = min(1.0, max(0.0, (3.0 / constants.sound_speed) * jump));
    const auto p_star = p.i(pressure) + p.j(pressure) + impedance * beta * jump;
    return sums((weight * p_star) * p.r_ij(),
                weight * (v_r + per_impedance * p.r() * (p.i(pressure) - p.j(pressure))));
  }
  void particle(auto i, auto force, auto divergence) const {
    pressure_acceleration[i] = (-1.0 / density[i]) * force;
    density_rate[i] = density[i] * divergence;
  }
};

}  // namespace shoal::bench
