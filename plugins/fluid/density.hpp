// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Density re-initialisation, at most once in an advection step (Zhang, Hu, Adams 2017; Rezavand, Zhang, Hu 2020):
//   rho_s = rho0 sum_j W_ij / sigma0,    sigma0 = sum of W over the lattice of the initial spacing, itself included
//   rho_i = rho_s                                          where no free surface is
//   rho_f = rho_s + max(0, rho_i - rho_s) rho0 / rho_i     with a free surface: where the support is cut off, the
//                                                          density of the continuity equation is kept
// so that errors of the continuity equation do not add up over many steps. The paper takes rho_f in each step. On
// disordered particles rho_s has a noise of some 0.2 %, of which rho_f keeps the upper half: densities and with them
// the mean pressure rise, and each correction sends out a sound wave. Here rho_i is kept within a tolerance of rho_f
// (1 % by default), and of what is beyond only a share is taken back in each step (5 % by default), in every second one
// twice of it.
#pragma once

#include <algorithm>
#include <memory>

#include "intermittent.hpp"

namespace shoal::fluid {

// sum_j V_j W_ij of the walls; runs before DensityReinitialisation, which adds it.
struct WallDensity : IntermittentPairOperator<WallDensity> {
  In<Scalar> wall_volume{"volume", neighbours_only};
  Out<Scalar> wall_sum{"wall_density_sum", unit("1"), doc("Sum of V W over wall particles."), derived};

  auto pair(const auto& p) const { return p.j(wall_volume) * p.W(); }
  void particle(auto i, auto sum) const { wall_sum[i] = sum; }
};

template <class Derived>
struct DensitySum : IntermittentPairOperator<Derived> {
  static constexpr bool single_in_3d_only = true;

  In<Scalar> mass{"mass", own_only};
  InOut<Scalar> density{"density"};
  Out<Scalar> volume{"volume"};

  double reference_density = 0;  // kg/m3
  double per_lattice_sum = 0;    // 1 / sigma0, m^D
  bool free_surface = true;
  double tolerance = 0;   // kg/m3
  double relaxation = 1;  // share of what is beyond the tolerance
  std::shared_ptr<SinglePrecision> single;

  auto pair(const auto& p) const { return p.W(); }

 protected:
  void reinitialise(auto i, double sum, double wall_sum) const {
    const double rest_volume = mass[i] / reference_density;
    const double summed =
        reference_density * per_lattice_sum * (sum + this->self_W() + wall_sum / rest_volume);
    const double excess =
        free_surface ? std::max(0.0, density[i] - summed) * reference_density / density[i] : 0.0;
    const double kept = std::clamp(density[i], summed + excess - tolerance, summed + excess + tolerance);
    density[i] += relaxation * (kept - density[i]);
    volume[i] = mass[i] / density[i];
  }
};

struct DensityReinitialisation : DensitySum<DensityReinitialisation> {
  void particle(auto i, double sum) const { reinitialise(i, sum, 0.0); }
};

struct DensityReinitialisationAtWalls : DensitySum<DensityReinitialisationAtWalls> {
  In<Scalar> wall_sum{"wall_density_sum", unit("1"), doc("Sum of V W over wall particles."), own_only};
  void particle(auto i, double sum) const { reinitialise(i, sum, wall_sum[i]); }
};

}  // namespace shoal::fluid
