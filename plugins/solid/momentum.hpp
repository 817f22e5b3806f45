// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Internal force,
//   rho0 a_i = sum_j [P_i G_ij - V_j / V_i P_j G_ji] - sum_j [q_i psi_ij - V_j / V_i q_j psi_ji],
// the exact transpose of F and of the hourglass residual (deformation.hpp): it is the gradient of the discrete energy
// sum_i V_i [W(F_i) + 1/2 alpha mu |r_i|^2 / dx^2], so linear and angular momentum are conserved to rounding, and
// energy by a symplectic integrator to its order.
#pragma once

#include "stencils.hpp"
#include "structure.hpp"

namespace shoal::solid {

template <bool Hourglass>
struct HourglassResistance {
  In<Vector> hourglass{"hourglass_stress", unit("N/m3"),
                       doc("Resistance to modes that alternate between particles.")};
};
template <>
struct HourglassResistance<false> {};

template <bool Hourglass>
struct InternalForceOf : ReferenceOperator, HourglassResistance<Hourglass> {
  In<Matrix> P{"piola_stress", unit("Pa"), doc("First Piola-Kirchhoff stress.")};
  Out<Vector> acceleration{"internal_acceleration", unit("m/s2"),
                           doc("Acceleration by the body's own stress."), derived};

  // Of the weights of both directions, which all operators of the structure share and one of them counts.
  bool counts_weights = false;
  std::uint32_t bytes_per_pair() const {
    return counts_weights ? 16 * static_cast<std::uint32_t>(dimensions() + 1) : 0;
  }

  template <int D>
  void run_chunk(const shoal_chunk& chunk) const {
    const double *stress = P.of_neighbours(0), *q = nullptr;
    if constexpr (Hourglass) q = this->hourglass.of_neighbours(0);
    const double per_density = 1.0 / structure->constants.density;
    double* a = acceleration.data();
    structure->weights.force<D, Hourglass>(chunk.begin, chunk.end, stress, q, per_density, a);
  }
};
using InternalForce = InternalForceOf<true>;

}  // namespace shoal::solid
