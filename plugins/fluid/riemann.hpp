// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Continuity and momentum with the low-dissipation Riemann solver (Zhang, Hu, Adams 2017):
//   dv_i/dt   = -(2/m_i) sum_j V_i V_j P* W' e_ij,      P* = (p_i + p_j)/2 + beta rho c (u_L - u_R)/2
//   drho_i/dt =  2 rho_i sum_j V_j (v_i - v*).e_ij W',  v*.e_ij = (v_i + v_j).e_ij/2 - (p_i - p_j)/(2 rho c)
//   u_L - u_R = -(v_i - v_j).e_ij,   beta = min(max(3 (u_L - u_R)/c, beta0), B)
// The paper has beta0 = 0: no dissipation in expansion, and next to none where the flow is slow. Here B takes the place
// of the 1, and the jump of the pressure in v* counts B times too. With the paper's B = 1 a checkerboard decays at the
// rate 3 c / h and acoustic steps above 2/3 h / c fail; B = 0.4, still twice the diffusion of delta-SPH, lets them be as
// long as sound does. Peaks of impacts want B = 1 (dam_break_3d), and so does a free patch under tension (square_patch);
// dam_break_2d, standing_wave and hydrostatic_2d do as well with 0.4.
// Densities differ by about 1 %, so the averages are plain ones, which saves a division and the densities of the
// neighbours. The terms are gathered where their fields are read anyway: those of the pressure (P* without beta, and
// its jump in v*) in PressureForce, those of the velocity in VelocityDivergence.
//
// The jump of a smooth pressure is no discontinuity: sum_j V_j (p_i - p_j) W' of it acts as a source of volume, by
// order h laplace(p) / (rho c) in the interior and more at free surfaces, where it lets the density of water at rest
// drift. What gradients explain of the jump is therefore taken off (as density diffusion does: Antuono et al. 2010,
// Fourtakas et al. 2019),
//   p_i - p_j - minmod(p_i - p_j, (grad p_i + grad p_j)/2 . r_ij),    grad p = -rho0 a_p
// a_p being the acceleration by pressure in the last acoustic step, walls included: no sum of its own is needed, and
// water at rest and in free fall are both exact.
#pragma once

#include <memory>
#include <tuple>

#include "shoal/pair_operator.hpp"

#include "gradient_matrix.hpp"

namespace shoal::fluid {

// The smaller of two numbers of one sign, 0 if their signs differ.
template <class A, class B>
auto minmod(const A& a, const B& b) {
  return max(0.0, min(a, b)) + min(0.0, max(a, b));
}

// The pressure's part: acceleration, and the dissipation of pressure jumps in the continuity equation.
template <bool Corrected>
struct PressureForceOf : PairOperator<PressureForceOf<Corrected>> {
  In<Scalar> pressure{"pressure"};
  In<Scalar> volume{"volume"};
  In<Scalar> mass{"mass", own_only};
  In<Scalar> density{"density", own_only};
  In<Vector> last_acceleration{"last_pressure_acceleration", unit("m/s2"),
                               doc("Acceleration by pressure in the last acoustic step.")};
  InOut<Vector> pressure_acceleration{"pressure_acceleration", unit("m/s2"),
                                      doc("Acceleration by pressure.")};
  MatrixIf<Corrected> matrix{"pressure_matrix", unit("1"), doc("Correction of gradients.")};
  Out<Scalar> density_diffusion{"density_diffusion", unit("kg/m3/s"),
                                doc("Rate of the density by dissipation of pressure jumps.")};

  double reference_density = 0;  // kg/m3
  double sound_speed = 0;        // m/s
  double dissipation = 1;        // B
  double gradient_scale = 1;     // 1 / slope of lattice_sums()
  std::shared_ptr<SinglePrecision> single;

  auto neighbour_fields() const { return std::tie(last_acceleration, pressure); }
  auto pair(const auto& p) const {
    const auto weight = p.weight(volume);
    const auto p_j = p.j(pressure);
    const auto jump = p.i(pressure) - p_j;
    const auto smooth =
        (-0.5 * reference_density) * dot(p.i(last_acceleration) + p.j(last_acceleration), p.r_ij());
    const auto diffusion = weight * p.r() * (jump - minmod(jump, smooth));
    if constexpr (Corrected)
      return sums(weight * (p.i(pressure) * (p.j(matrix) * p.r_ij()) + p_j * (p.i(matrix) * p.r_ij())),
                  diffusion);
    else
      return sums((weight * (p.i(pressure) + p_j)) * p.r_ij(), diffusion);
  }
  void particle(auto i, auto force, auto diffusion) const {
    const double per_mass = 1.0 / mass[i];
    pressure_acceleration[i] -= ((Corrected ? 1.0 : gradient_scale) * per_mass) * force;
    density_diffusion[i] = (dissipation * gradient_scale / sound_speed * density[i] * per_mass) * diffusion;
  }
};

using PressureForce = PressureForceOf<false>;

// The velocity's part: divergence, and the dissipation of approaching velocities, kept for the next PressureForce.
template <bool Corrected>
struct VelocityDivergenceOf : PairOperator<VelocityDivergenceOf<Corrected>> {
  In<Vector> velocity{"velocity"};
  In<Scalar> volume{"volume"};
  In<Scalar> mass{"mass", own_only};
  In<Scalar> density{"density", own_only};
  MatrixIf<Corrected> matrix{"gradient_matrix", own_only, unit("1"), doc("Correction of gradients.")};
  Out<Vector> pressure_acceleration{"pressure_acceleration", unit("m/s2"), doc("Acceleration by pressure.")};
  Out<Scalar> compression{"compression_rate", unit("kg/m3/s"),
                          doc("Rate of the density by convergence of the velocity.")};

  double reference_density = 0;  // kg/m3
  double sound_speed = 0;        // m/s
  double limiter = 3.0;          // eta of the paper
  double least = 0.0;            // smallest beta, also in expansion
  double most = 1.0;             // B, the largest
  double gradient_scale = 1;     // 1 / slope of lattice_sums()
  std::shared_ptr<SinglePrecision> single;

  auto neighbour_fields() const { return std::tie(velocity); }
  auto pair(const auto& p) const {
    const auto weight = p.weight(volume);
    const auto v = p.i(velocity) - p.j(velocity);
    const auto v_r = dot(v, p.r_ij());
    const auto jump = -v_r * p.per_r();  // u_L - u_R
    const auto beta = min(most, max(least, steepness_ * jump));
    const auto dissipation = (weight * beta * jump) * p.r_ij();
    if constexpr (Corrected)
      return sums(weight * dot(v, p.i(matrix) * p.r_ij()), dissipation);
    else
      return sums(weight * v_r, dissipation);
  }
  void particle(auto i, auto divergence, auto dissipation) const {
    const double per_mass = 1.0 / mass[i];
    compression[i] = ((Corrected ? 1.0 : gradient_scale) * density[i] * density[i] * per_mass) * divergence;
    pressure_acceleration[i] = (-gradient_scale * reference_density * sound_speed * per_mass) * dissipation;
  }
  void begin() { steepness_ = limiter / sound_speed; }

 private:
  double steepness_ = 0;  // of beta over the jump, s/m
};

using VelocityDivergence = VelocityDivergenceOf<false>;

}  // namespace shoal::fluid
