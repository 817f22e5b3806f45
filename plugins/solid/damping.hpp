// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Damping; each is an operator of its own and not there unless asked for.
//   MassDamping      a_i -= c v_i, to come to rest
//   KelvinVoigt      P += F 2 eta dE/dt, viscosity eta of the material, E the Green-Lagrange strain; turns with the body
//   PairDamping      a_i += 2 b c h sum_j V_j (W'/r) (v_ij . e_ij) e_ij, along the current line between neighbours of the
//                    reference configuration: against impact noise; it keeps momentum and angular momentum
#pragma once

#include "reference_weights.hpp"
#include "shoal/pair_operator.hpp"
#include "shoal/particle_operator.hpp"
#include "structure.hpp"

namespace shoal::solid {

struct MassDamping : ParticleOperator<MassDamping> {
  In<Vector> velocity{"velocity"};
  Accumulate<Vector> acceleration{"acceleration"};
  double coefficient = 0;  // 1/s

  void particle(auto i) const { acceleration[i] -= coefficient * velocity[i]; }
};

struct KelvinVoigt : ParticleOperator<KelvinVoigt> {
  In<Matrix> F{"deformation_gradient"};
  InOut<Matrix> before{"previous_deformation_gradient", unit("1"), doc("F of the last step.")};
  InOut<Matrix> P{"piola_stress", unit("Pa"), doc("First Piola-Kirchhoff stress.")};
  double viscosity = 0;  // Pa s

  void particle(auto i) const {
    const auto rate = (1.0 / dt()) * (F[i] - before[i]);
    const auto half = transpose(rate) * F[i];
    P[i] += viscosity * (F[i] * (half + transpose(half)));
    before[i] = F[i];
  }
};
struct InitialKelvinVoigt : ParticleOperator<InitialKelvinVoigt> {
  Out<Matrix> before{"previous_deformation_gradient", unit("1"), doc("F of the last step.")};
  void particle(auto i) const { before[i] = identity<decltype(i)::dimensions>(); }
};

// Rate at which pair damping takes velocity from a mode that alternates from particle to particle, at most: with
// sum_j V_j |W'/r| = 3.5 / h^2 for the Wendland kernel C2, of which 1 / D acts along each axis, from both sides of a pair.
inline double pair_damping_rate(double b, const shoal_elastic_constants& constants, double h,
                                int dimensions) {
  return 4.0 * 3.5 / dimensions * b * constants.longitudinal_speed / h;
}

struct PairDamping : PairOperator<PairDamping> {
  static constexpr const char* pair_geometry = "reference_position";
  template <int D>
  using Kernel = WendlandC2<D>;
  In<Scalar> volume{"volume"};
  In<Vector> position{"position"};
  In<Vector> velocity{"velocity"};
  Accumulate<Vector> acceleration{"acceleration"};
  double strength = 0;  // b c h, m2/s

  auto store(const auto& p) const { return p.j(volume) * p.dW_over_r(); }
  auto pair(const auto& p, const auto& weight) const {
    const auto x = p.i(position) - p.j(position);
    const auto v = p.i(velocity) - p.j(velocity);
    return (2.0 * strength * weight * dot(v, x) / max(1e-200, squared_norm(x))) * x;
  }
  void particle(auto i, auto sum) const { acceleration[i] += sum; }
};

}  // namespace shoal::solid
