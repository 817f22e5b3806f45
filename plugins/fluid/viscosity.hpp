// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Viscous acceleration (Morris, Fox, Zhu 1997; Hu, Adams 2006):
//   dv_i/dt = (2 eta / m_i) sum_j V_i V_j (v_i - v_j) W' / r
// (the papers have r + 0.01 h, against coincident particles: it takes 0.7 % of the viscosity off, whatever the spacing, and
// W'/r is finite), evaluated once in an advection step. On a lattice stable for dt <= 0.3 h^2 / nu of that step (with
// h = 1.3 dx the fastest mode decays at the rate 6.5 nu / h^2 in 2D, 6.8 in 3D: the sum over the lattice); 0.2 is used, and
// 0.125 next to no-slip walls, which count up to
// four times, and for forces along the line of two particles, which damp longitudinal modes three times as fast.
//
// A no-slip wall's particle carries the velocity that continues the fluid's linearly through the wall's surface,
//   v_w' = v_w - (d_w / d_i)(v_i - v_w),   v_i - v_w' = (1 + d_w / d_i)(v_i - v_w),
// d_i and d_w being the distances of the two particles from the surface. The factor is bounded by 4 (1.5 in the paper:
// measured on Couette flow, the smaller bound makes the wall slip).
#pragma once

#include <memory>
#include <tuple>

#include "shoal/pair_operator.hpp"

namespace shoal::fluid {

// 1 + d_w / d_i. `across` is the distance of the particles along the wall's normal, d_i + d_w; `signed_distance` is
// that of the wall's particle, -d_w.
template <class R, class S>
auto no_slip_factor(const R& across, const S& signed_distance) {
  const auto depth = max(0.0, -signed_distance);
  return min(4.0, across / max(0.25 * across + 1e-300, across - depth));
}

// What a pair exchanges for the difference of velocities v and the weight V_i V_j W'/r; the sum counts `factor` times.
struct MorrisForm {
  static double factor(int) { return 2.0; }
  static constexpr double longest_step = 0.2;  // dt nu / h^2, away from walls
  static auto exchange(const auto&, const auto& weight, const auto& v) { return weight * v; }
};

template <class Form>
struct ViscousForceOf : PairOperator<ViscousForceOf<Form>> {
  In<Vector> velocity{"velocity"};
  In<Scalar> volume{"volume"};
  In<Scalar> mass{"mass", own_only};
  Accumulate<Vector> acceleration{"acceleration"};

  double viscosity = 0;          // Pa s
  double reference_density = 0;  // kg/m3
  double gradient_scale = 1;     // 1 / slope of lattice_sums()
  double longest_step = 0.125;   // dt nu / h^2
  static constexpr double longest_step_in_the_open = Form::longest_step;
  std::shared_ptr<SinglePrecision> single;

  auto neighbour_fields() const { return std::tie(velocity); }
  auto pair(const auto& p) const {
    return Form::exchange(p, p.weight(volume), p.i(velocity) - p.j(velocity));
  }
  void particle(auto i, auto sum) const {
    acceleration[i] += (Form::factor(i.dimensions) * gradient_scale * viscosity / mass[i]) * sum;
  }
  double time_step(double h) const { return longest_step * h * h * reference_density / viscosity; }
};

using ViscousForce = ViscousForceOf<MorrisForm>;

// The share of the no-slip walls.
template <class Form>
struct WallViscousForceOf : PairOperator<WallViscousForceOf<Form>> {
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
    return Form::exchange(p, p.j(wall_volume) * no_slip_factor(across, p.j(wall_distance)) * p.dW_over_r(),
                          p.i(velocity) - p.j(wall_velocity));
  }
  void particle(auto i, auto sum) const {
    acceleration[i] += (Form::factor(i.dimensions) * gradient_scale * viscosity / density[i]) * sum;
  }
};

using WallViscousForce = WallViscousForceOf<MorrisForm>;

}  // namespace shoal::fluid
