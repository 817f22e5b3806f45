// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Velocities carried along the shift (transport_shift of advection_step.hpp): a particle that is put elsewhere gets the
// velocity that the flow has there,
//   v_i += L_i dr_i,   L_i = [sum_j V_j (v_j - v_i) (x) grad W_ij] B_i        (Bonet, Lok 1999; over the fluid alone)
// with dr_i as ApplyShift bounds it. Without it shifts mix momentum across shear layers, as a viscosity would: it raises
// the lift of a cylinder at Re 100 with D/dx = 10 by a quarter (case cylinder_channel_100, acoustic_damping 1.2).
#pragma once

#include <algorithm>

#include "shoal/pair_operator.hpp"
#include "shoal/particle_operator.hpp"

namespace shoal::fluid {

inline constexpr const char* carried_change_doc = "What carrying along the shift adds to the velocity.";

// Runs after the shift is known and before it is applied.
struct ShiftChange : PairOperator<ShiftChange> {
  In<Vector> velocity{"velocity"};
  In<Scalar> volume{"volume"};
  In<Vector> shift{"transport_shift", unit("m"), doc("Shift of the particle in this advection step."),
                   derived, own_only};
  Out<Vector> change{"shift_velocity_change", unit("m/s"), doc(carried_change_doc), derived};

  auto pair(const auto& p) const {
    const auto gradient = (-1.0 * p.j(volume) * p.dW_over_r()) * p.r_ij();
    return sums(outer(p.i(velocity) - p.j(velocity), gradient), outer(p.r_ij(), gradient));
  }
  template <int D>
  void particle(Particle<D> i, const Mat<D>& dv, const Mat<D>& moment) const {
    constexpr double least =
        D == 2 ? 0.01 : 0.001;  // of the determinant; 1/16 and 1/512 in corners of the fluid
    if (!(determinant(moment) > least)) {
      change[i] = Vec<D>{};
      return;
    }
    const double length = norm(shift[i]), limit = 0.1 * spacing();
    change[i] = (length > limit ? limit / length : 1.0) * (dv * (inverse(moment) * shift[i]));
  }
};

struct CarryVelocity : ParticleOperator<CarryVelocity> {
  In<Vector> change{"shift_velocity_change", unit("m/s"), doc(carried_change_doc), derived};
  InOut<Vector> velocity{"velocity"};

  void particle(auto i) const { velocity[i] += change[i]; }
};

}  // namespace shoal::fluid
