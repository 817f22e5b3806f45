// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The pressure's part of continuity and momentum without a Riemann solver: the plain force, and diffusion of density that
// damps noise of the pressure,
//   dv_i/dt   = -(1/m_i) sum_j V_i V_j (p_i + p_j) grad W_ij
//   drho_i/dt = 2 D sum_j V_j [(rho_i - rho_j) - S_ij] W'_ij / r_ij,      rho_i - rho_j = (p_i - p_j) / c^2
//   antuono    D = delta h c,  S_ij = (grad rho_i + grad rho_j)/2 . r_ij   (Antuono et al. 2010; Marrone et al. 2011)
//   fourtakas  D = delta h c,  S_ij = rho0 g . r_ij / c^2: the hydrostatic density    (Fourtakas et al. 2019)
//   edac       D = alpha h c / 8,  S_ij = 0: with a linear equation of state entropically damped artificial
//              compressibility, dp/dt = -rho c^2 div v + D lap p                 (Ramachandran, Puri 2019)
// S is what a smooth pressure explains: without it a column of water at rest drifts, as it does with edac. The gradient is
// -rho0 a_p / c^2, a_p the acceleration by pressure in the last acoustic step, walls included, where the papers take a
// corrected gradient, which wants two passes more.
// Explicit: stable for D <= 0.5 h c about, delta <= 0.5.
#pragma once

#include <memory>
#include <tuple>

#include "shoal/pair_operator.hpp"
#include "shoal/physics.hpp"

#include "gradient_matrix.hpp"

namespace shoal::fluid {

enum class Diffusion { none, antuono, fourtakas, edac };

template <bool Present>
using VectorIf = std::conditional_t<Present, In<Vector>, NoField>;

template <Diffusion Kind, bool Corrected>
struct DiffusivePressureForce : PairOperator<DiffusivePressureForce<Kind, Corrected>> {
  In<Scalar> pressure{"pressure"};
  In<Scalar> volume{"volume"};
  In<Scalar> mass{"mass", own_only};
  In<Scalar> density{"density", own_only};
  VectorIf<Kind == Diffusion::antuono> last_acceleration{
      "last_pressure_acceleration", unit("m/s2"), doc("Acceleration by pressure in the last acoustic step.")};
  InOut<Vector> pressure_acceleration{"pressure_acceleration", unit("m/s2"),
                                      doc("Acceleration by pressure.")};
  MatrixIf<Corrected> matrix{"pressure_matrix", unit("1"), doc("Correction of the gradient of pressure.")};
  Out<Scalar> density_diffusion{"density_diffusion", unit("kg/m3/s"),
                                doc("Rate of the density by dissipation of pressure jumps.")};

  double reference_density = 0;  // kg/m3
  double sound_speed = 0;        // m/s
  double diffusivity = 0;        // D, m2/s
  double gradient_scale = 1;     // 1 / slope of lattice_sums()
  Vector3 gravity{};             // m/s2
  std::shared_ptr<SinglePrecision> single;

  auto neighbour_fields() const {
    if constexpr (Kind == Diffusion::antuono)
      return std::tie(last_acceleration, pressure);
    else
      return std::tie(pressure);
  }
  auto pair(const auto& p) const {
    const auto weight = p.weight(volume);
    const auto p_j = p.j(pressure);
    const auto force = [&] {
      if constexpr (Corrected)
        return weight * (p.i(pressure) * (p.j(matrix) * p.r_ij()) + p_j * (p.i(matrix) * p.r_ij()));
      else
        return (weight * (p.i(pressure) + p_j)) * p.r_ij();
    }();
    if constexpr (Kind == Diffusion::none) {
      return force;
    } else {
      auto jump = p.i(pressure) - p_j;
      if constexpr (Kind == Diffusion::antuono)
        jump += (0.5 * reference_density) * dot(p.i(last_acceleration) + p.j(last_acceleration), p.r_ij());
      if constexpr (Kind == Diffusion::fourtakas)
        for (int a = 0; a < std::decay_t<decltype(p)>::dimensions; ++a)
          jump -= (reference_density * gravity[static_cast<std::size_t>(a)]) * p.r_ij()[a];
      return sums(force, weight * jump);
    }
  }
  void particle(auto i, auto force) const { particle(i, force, 0.0); }
  void particle(auto i, auto force, double diffused) const {
    pressure_acceleration[i] -= ((Corrected ? 1.0 : gradient_scale) / mass[i]) * force;
    density_diffusion[i] =
        (2.0 * gradient_scale * diffusivity / (sound_speed * sound_speed) * density[i] / mass[i]) * diffused;
  }
};

// The velocity's part: divergence and Monaghan's artificial viscosity (Monaghan 1992) between approaching particles,
//   dv_i/dt = alpha c h (rho0/m_i) sum_j V_i V_j min(0, v_ij.r_ij) / (r^2 + 0.01 h^2) grad W_ij
// kept for the next DiffusivePressureForce. A shear viscosity of alpha c h / (2 (D + 2)).
template <bool Corrected>
struct ViscousDivergence : PairOperator<ViscousDivergence<Corrected>> {
  In<Vector> velocity{"velocity"};
  In<Scalar> volume{"volume"};
  In<Scalar> mass{"mass", own_only};
  In<Scalar> density{"density", own_only};
  MatrixIf<Corrected> matrix{"gradient_matrix", own_only, unit("1"), doc("Correction of gradients.")};
  Out<Vector> pressure_acceleration{"pressure_acceleration", unit("m/s2"), doc("Acceleration by pressure.")};
  Out<Scalar> compression{"compression_rate", unit("kg/m3/s"),
                          doc("Rate of the density by convergence of the velocity.")};

  double alpha = 0;
  double sound_speed = 0;        // m/s
  double reference_density = 0;  // kg/m3
  double gradient_scale = 1;     // 1 / slope of lattice_sums()
  std::shared_ptr<SinglePrecision> single;

  auto neighbour_fields() const { return std::tie(velocity); }
  auto pair(const auto& p) const {
    const auto weight = p.weight(volume);
    const auto v = p.i(velocity) - p.j(velocity);
    const auto v_r = dot(v, p.r_ij());
    const auto viscous = (weight * min(v_r, 0.0) / (p.r() * p.r() + 0.01 * p.h() * p.h())) * p.r_ij();
    if constexpr (Corrected)
      return sums(weight * dot(v, p.i(matrix) * p.r_ij()), viscous);
    else
      return sums(weight * v_r, viscous);
  }
  void particle(auto i, auto divergence, auto viscous) const {
    compression[i] = (Corrected ? 1.0 : gradient_scale) * density[i] * density[i] / mass[i] * divergence;
    pressure_acceleration[i] =
        (gradient_scale * alpha * sound_speed * this->smoothing_length() * reference_density / mass[i]) *
        viscous;
  }
};

}  // namespace shoal::fluid
