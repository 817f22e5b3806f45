// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What a flow looks like, for outputs and probes that ask for it:
//   L = grad v,   omega = curl v,   Q = (tr(L)^2 - tr(L L)) / 2, positive in vortices (Hunt, Wray, Moin 1988)
// with the gradient of Bonet and Lok (1999), of the particles of the fluid alone,
//   L_i = [sum_j V_j (v_j - v_i) (x) grad W_ij] B_i,   B_i = [sum_j V_j r_ji (x) grad W_ij]^-1,
// exact for linear velocities, at walls and free surfaces too. Where neighbours do not span the space, as in a spray, zero.
#pragma once

#include "shoal/pair_operator.hpp"
#include "shoal/physics.hpp"

namespace shoal::fluid {

// Vorticity is a number in two dimensions and a vector in three: `Rank`.
template <class Rank>
struct Kinematics : PairOperator<Kinematics<Rank>> {
  In<Vector> velocity{"velocity"};
  In<Scalar> volume{"volume"};
  Out<Rank> vorticity{"vorticity", unit("1/s"), doc("Curl of the velocity."), derived};
  Out<Scalar> q_criterion{"q_criterion", unit("1/s2"),
                          doc("Second invariant of the velocity's gradient, positive in vortices."), derived};

  auto pair(const auto& p) const {
    const auto gradient = (-1.0 * p.j(volume) * p.dW_over_r()) * p.r_ij();
    return sums(outer(p.i(velocity) - p.j(velocity), gradient), outer(p.r_ij(), gradient));
  }
  template <int D>
  void particle(Particle<D> i, const Mat<D>& dv, const Mat<D>& moment) const {
    constexpr double least =
        D == 2 ? 0.01 : 0.001;  // of the determinant; 1/16 and 1/512 in corners of the fluid
    const Mat<D> L = determinant(moment) > least ? dv * inverse(moment) : Mat<D>{};
    if constexpr (D == 2)
      set(vorticity[i], L(1, 0) - L(0, 1));
    else
      set(vorticity[i], Vec<D>{L(2, 1) - L(1, 2), L(0, 2) - L(2, 0), L(1, 0) - L(0, 1)});
    q_criterion[i] = 0.5 * (trace(L) * trace(L) - trace(L * L));
  }

 private:
  // The rank that the case does not have compiles, but is never attached.
  template <class A, class B>
  static void set(A& field, const B& value) {
    if constexpr (std::is_assignable_v<A&, const B&>) field = value;
  }
};

inline void attach_kinematics(const Builder& b, const Target& target) {
  const auto none = [](auto&) {};
  const At at{SHOAL_SAMPLE, "kinematics"};
  if (b.dimensions() == 2)
    b.attach<Kinematics<Scalar>>("fluid.kinematics", at, target, none, SHOAL_OPERATOR_ON_DEMAND);
  else
    b.attach<Kinematics<Vector>>("fluid.kinematics", at, target, none, SHOAL_OPERATOR_ON_DEMAND);
}

}  // namespace shoal::fluid
