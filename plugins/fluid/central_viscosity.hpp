// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Viscous acceleration along the line of two particles (Monaghan, Gingold 1983; with this factor Monaghan 2005, eq. 8.9):
//   dv_i/dt = 2 (D + 2) (eta / rho_i) sum_j V_j (v_ij.r_ij) / r^2 grad W_ij
// Pairs exchange opposite central forces: angular momentum is kept to rounding, which the form of viscosity.hpp does not
// do. It holds a bulk viscosity of 5/3 eta, nothing to an incompressible flow. At no-slip walls velocities are continued as
// in viscosity.hpp. Evaluated once in an advection step; stable for dt <= 0.125 h^2 / nu of that step.
#pragma once

#include "viscosity.hpp"

namespace shoal::fluid {

struct CentralForm {
  static double factor(int dimensions) { return 2.0 * (dimensions + 2); }
  static constexpr double longest_step = 0.125;  // dt nu / h^2
  static auto exchange(const auto& p, const auto& weight, const auto& v) {
    return (weight * dot(v, p.e())) * p.e();
  }
};

using CentralViscousForce = ViscousForceOf<CentralForm>;
using WallCentralViscousForce = WallViscousForceOf<CentralForm>;

}  // namespace shoal::fluid
