// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Walls: a one-sided Riemann problem between a fluid particle i and the wall's particle j (Zhang, Hu, Adams 2017;
// Zhang, Rezavand, Hu 2021). The wall's state is the mirror image of the fluid's:
//   pressure  p_w = p_i + rho a_i.(r_j - r_i): the linear field that balances the acceleration a_i by all but pressure
//             (gravity), so that a fluid at rest feels the exact hydrostatic force; p_w >= min(p_i, 0): a wall does
//             not pull
//   velocity  v_w' = v_i - 2 [(v_i - v_w).n] n            n: the wall's normal, towards the fluid
// With a free surface a wall does not pull particles that touch it either (n.(x_i - s_j) < dx/4, s_j the surface next to j):
// P = max(p_i + p_w, 0) for those. Suction of some 20 kPa beside the sharp edges of an obstacle drew particles into it.
// The papers take max(0, -a_i.e) r instead of the full field. At a vertical wall that drops the wall particles
// above i, and half of the vertical pressure gradient with them: the fluid at the wall sinks.
#pragma once

#include <memory>
#include <tuple>

#include "shoal/pair_operator.hpp"

#include "gradient_matrix.hpp"
#include "viscosity.hpp"

namespace shoal::fluid {

// 1 or -1: the side of the wall on which the fluid is, `across` being how far along the wall's normal. Behind the middle
// of a shell the normal points outward.
template <class R>
R side_of(const R& across) {
  return select(across < 0.0, R(-1.0), R(1.0));
}
// The wall's normal, turned to that side.
template <class Normal, class Direction>
auto towards(const Direction& fluid, const Normal& n) {
  return side_of(dot(n, fluid)) * n;
}

// Pressure of the wall's image of a fluid particle; `to_wall` is the wall particle's position less the fluid's.
template <class P, class A, class X>
auto wall_pressure(double rho, const P& fluid_pressure, const A& acceleration, const X& to_wall) {
  return max(min(fluid_pressure, 0.0), fluid_pressure + rho * dot(acceleration, to_wall));
}

// p_i + p_w, not below zero where the fluid's particle is `distance` from the surface and that is less than `touching`.
template <class P, class W, class S>
auto without_pull(const P& fluid, const W& wall, const S& distance, double touching) {
  const auto both = fluid + wall;
  return select(distance < touching, max(0.0, both), both);
}

// The walls' share of PressureForce. Runs after it.
template <bool Corrected>
struct WallPressureForceOf : PairOperator<WallPressureForceOf<Corrected>> {
  static constexpr bool skips_lonely = true;
  static constexpr bool single_in_3d_only = true;

  In<Scalar> pressure{"pressure", own_only};
  In<Scalar> density{"density", own_only};
  In<Vector> acceleration{"acceleration", own_only};
  MatrixIf<Corrected> matrix{"pressure_matrix", own_only, unit("1"), doc("Correction of gradients.")};
  In<Scalar> volume{"volume", neighbours_only};
  In<Vector> wall_normal{"normal", neighbours_only};
  In<Scalar> wall_distance{"signed_distance", neighbours_only};
  InOut<Vector> pressure_acceleration{"pressure_acceleration", unit("m/s2"),
                                      doc("Acceleration by pressure.")};

  double reference_density = 0;  // kg/m3
  double gradient_scale = 1;     // 1 / slope of lattice_sums()
  double touching = -1e300;      // m
  std::shared_ptr<SinglePrecision> single;

  auto neighbour_fields() const { return std::tie(wall_normal, wall_distance); }
  auto pair(const auto& p) const {
    const auto p_w = wall_pressure(reference_density, p.i(pressure), p.i(acceleration), -p.r_ij());
    const auto distance = dot(p.j(wall_normal), p.r_ij()) + p.j(wall_distance);
    const auto weight = p.j(volume) * p.dW_over_r() * without_pull(p.i(pressure), p_w, distance, touching);
    if constexpr (Corrected)
      return weight * (p.i(matrix) * p.r_ij());
    else
      return weight * p.r_ij();
  }
  void particle(auto i, auto force) const {
    pressure_acceleration[i] -= ((Corrected ? 1.0 : gradient_scale) / density[i]) * force;
  }
};

using WallPressureForce = WallPressureForceOf<false>;

// The walls' share of VelocityDivergence. Runs after it.
template <bool Corrected>
struct WallVelocityDivergenceOf : PairOperator<WallVelocityDivergenceOf<Corrected>> {
  static constexpr bool skips_lonely = true;
  static constexpr bool single_in_3d_only = true;

  In<Vector> velocity{"velocity", own_only};
  In<Scalar> density{"density", own_only};
  In<Vector> wall_velocity{"velocity", neighbours_only};
  In<Vector> wall_normal{"normal", neighbours_only};
  MatrixIf<Corrected> matrix{"gradient_matrix", own_only, unit("1"), doc("Correction of gradients.")};
  In<Scalar> volume{"volume", neighbours_only};
  InOut<Vector> pressure_acceleration{"pressure_acceleration", unit("m/s2"),
                                      doc("Acceleration by pressure.")};
  InOut<Scalar> compression{"compression_rate", unit("kg/m3/s"),
                            doc("Rate of the density by convergence of the velocity.")};

  double sound_speed = 0;  // m/s
  double limiter = 3.0;
  double most = 1.0;          // B of riemann.hpp
  double gradient_scale = 1;  // 1 / slope of lattice_sums()
  std::shared_ptr<SinglePrecision> single;

  auto neighbour_fields() const { return std::tie(wall_normal, wall_velocity); }
  auto pair(const auto& p) const {
    const auto weight = p.j(volume) * p.dW_over_r();
    const auto normal = p.j(wall_normal);
    const auto across = dot(normal, p.r_ij());
    const auto side = side_of(across);                                              // n = side * normal
    const auto v_n = 2.0 * side * dot(p.i(velocity) - p.j(wall_velocity), normal);  // (v_i - v_w').n
    const auto approach = max(0.0, -v_n);
    const auto beta = min(most, (limiter / sound_speed) * approach);
    const auto dissipation = (weight * p.r() * beta * approach * side) * normal;
    if constexpr (Corrected)
      return sums(weight * v_n * side * dot(normal, p.i(matrix) * p.r_ij()), dissipation);
    else
      return sums(weight * v_n * abs(across), dissipation);
  }
  void particle(auto i, auto divergence, auto dissipation) const {
    compression[i] += (Corrected ? 1.0 : gradient_scale) * density[i] * divergence;
    pressure_acceleration[i] -= gradient_scale * sound_speed * dissipation;
  }
};

using WallVelocityDivergence = WallVelocityDivergenceOf<false>;

// Force of the fluid on each wall particle, in N: the opposite of what the walls do to the fluid. On demand.
// Here i is the wall's particle and j the fluid's.
template <bool Corrected>
struct WallForceOf : PairOperator<WallForceOf<Corrected>> {
  In<Vector> velocity{"velocity"};
  In<Scalar> volume{"volume"};
  In<Vector> wall_normal{"normal", own_only};
  In<Scalar> wall_distance{"signed_distance", own_only};
  In<Scalar> pressure{"pressure", neighbours_only};
  In<Vector> acceleration{"acceleration", neighbours_only};
  MatrixIf<Corrected> matrix{"pressure_matrix", neighbours_only, unit("1"), doc("Correction of gradients.")};
  Out<Vector> force{"force", derived};

  double reference_density = 0;  // kg/m3
  double sound_speed = 0;        // m/s
  double viscosity = 0;          // Pa s; 0 on free-slip walls
  double limiter = 3.0;
  double most = 1.0;          // B of riemann.hpp
  double gradient_scale = 1;  // 1 / slope of lattice_sums()
  double touching = -1e300;   // m, as of WallPressureForce

  auto pair(const auto& p) const {
    const auto weight = p.j(volume) * p.dW_over_r();
    const auto p_j = p.j(pressure);
    const auto p_w = wall_pressure(reference_density, p_j, p.j(acceleration), p.r_ij());
    const auto distance = p.i(wall_distance) - dot(p.i(wall_normal), p.r_ij());
    const auto both = without_pull(p_j, p_w, distance, touching);
    const auto n = towards(-p.r_ij(), p.i(wall_normal));
    const auto v = p.j(velocity) - p.i(velocity);
    const auto approach = max(0.0, -2.0 * dot(v, n));
    const auto impact =
        reference_density * sound_speed * approach * min(most, (limiter / sound_speed) * approach);
    const auto shear = 2.0 * viscosity * no_slip_factor(-dot(n, p.r_ij()), p.i(wall_distance));
    const auto smooth = weight * gradient_scale * (impact * p.r() * n - shear * v);
    if constexpr (Corrected)
      return smooth - (weight * both) * (p.j(matrix) * p.r_ij());
    else
      return smooth - (weight * gradient_scale * both) * p.r_ij();
  }
  void particle(auto i, auto sum) const { force[i] = volume[i] * sum; }
};

using WallForce = WallForceOf<false>;

}  // namespace shoal::fluid
