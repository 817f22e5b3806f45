// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// solid.contact: bodies that touch each other or themselves, with friction.
//
// Each particle sees how much of the other body is near it, phi_i = sum_j V_j W_ij in the current configuration, and
// the overlap o_i = max(0, phi_i - phi_0), phi_0 being what it sees when the bodies just touch (contact_scale.hpp).
// Their energy, sum_i V_i K o_i^2 / 2 over the particles of both, has the derivative
//   F_i = -K sum_j V_i V_j (o_i + o_j) W'(r_ij) e_ij,
// so that contact conserves linear and angular momentum to rounding, and energy. Because phi is a sum over many
// particles a surface is felt as smooth, not as a row of balls: a body that slides on a lattice meets no bumps.
// Coulomb friction, of the pair's part f_n of the normal force and opposite on both bodies, stops the sliding of
// the pair within about ten steps where it is strong enough:
//   F_i -= min(mu f_n, 0.1 m_ij |v_t| / dt) v_t / |v_t|,   v_t = v_ij less its part along n,   m_ij = m_i m_j / (m_i + m_j)
// K is such that surfaces that overlap by x dx press with `stiffness` M x, M the smaller wave modulus of the two:
// contact is then as stiff as the row of particles next to it, and the step allows for it (added_stiffness.hpp).
// The idea of a density of the other body is SPHinXsys's (Zhang et al. 2021), the energy behind it is not.
#pragma once

#include <string>

#include "added_stiffness.hpp"
#include "shoal/pair_operator.hpp"
#include "shoal/physics.hpp"

namespace shoal::solid {

// Which pairs may touch: all of two bodies, or those of one body that were far apart in the reference configuration.
struct AnyPair {
  auto of(const auto&, auto value) const { return value; }
};
struct FarPair {
  In<Vector> reference_position{"reference_position"};
  double distance = 0;  // m

  auto of(const auto& p, auto value) const {
    const auto X = p.i(reference_position) - p.j(reference_position);
    return select(squared_norm(X) > distance * distance, value, decltype(value){});
  }
};

// The names of the fields of overlaps and normals depend on the partner, see contact.cpp.
template <class Pairs>
struct ContactOverlap : PairOperator<ContactOverlap<Pairs>> {
  template <int D>
  using Kernel = WendlandC2<D>;
  In<Scalar> volume{"volume", neighbours_only};
  Out<Scalar> overlap{"contact_overlap", unit("1"), doc("Overlap with a body in contact."), derived};
  Pairs pairs_in_contact;
  double touching = 0;  // phi_0

  auto pair(const auto& p) const { return pairs_in_contact.of(p, p.j(volume) * p.W()); }
  void particle(auto i, double colour) const { overlap[i] = max(0.0, colour - touching); }
};

// -grad phi / |grad phi|, which friction needs.
template <class Pairs>
struct ContactNormal : PairOperator<ContactNormal<Pairs>> {
  template <int D>
  using Kernel = WendlandC2<D>;
  In<Scalar> volume{"volume", neighbours_only};
  Out<Vector> normal{"contact_normal", unit("1"), doc("Direction away from a body in contact."), derived};
  Pairs pairs_in_contact;

  auto pair(const auto& p) const { return pairs_in_contact.of(p, p.j(volume) * p.grad_W()); }
  void particle(auto i, auto gradient) const {
    normal[i] = (-1.0 / max(1e-300, std::sqrt(squared_norm(gradient)))) * gradient;
  }
};

// In contact of a body with itself `own_overlap` and `other_overlap` are one field.
template <class Pairs>
struct ContactForce : PairOperator<ContactForce<Pairs>> {
  template <int D>
  using Kernel = WendlandC2<D>;
  In<Scalar> volume{"volume"};
  In<Scalar> mass{"mass", own_only};
  In<Scalar> own_overlap{"contact_overlap", own_only, unit("1"), doc("Overlap with a body in contact.")};
  In<Scalar> other_overlap{"contact_overlap", neighbours_only, unit("1"),
                           doc("Overlap with a body in contact.")};
  Accumulate<Vector> acceleration{"acceleration"};
  Pairs pairs_in_contact;
  double K = 0;  // Pa
  SharedStiffness added;

  static constexpr bool skips_lonely = true;
  auto pair(const auto& p) const {
    const auto overlaps = p.i(own_overlap) + p.j(other_overlap);
    return pairs_in_contact.of(p, (-K * overlaps * (p.i(volume) * p.j(volume))) * p.grad_W());
  }
  void particle(auto i, auto force) const { acceleration[i] += (1.0 / mass[i]) * force; }
};

template <class Pairs>
struct ContactFriction : PairOperator<ContactFriction<Pairs>> {
  template <int D>
  using Kernel = WendlandC2<D>;
  In<Scalar> volume{"volume"};
  In<Scalar> mass{"mass"};
  In<Vector> velocity{"velocity"};
  In<Scalar> own_overlap{"contact_overlap", own_only, unit("1"), doc("Overlap with a body in contact.")};
  In<Scalar> other_overlap{"contact_overlap", neighbours_only, unit("1"),
                           doc("Overlap with a body in contact.")};
  In<Vector> own_normal{"contact_normal", own_only, unit("1"), doc("Direction away from a body in contact.")};
  In<Vector> other_normal{"contact_normal", neighbours_only, unit("1"),
                          doc("Direction away from a body in contact.")};
  Accumulate<Vector> acceleration{"acceleration"};
  Pairs pairs_in_contact;
  double K = 0;         // Pa
  double friction = 0;  // mu

  static constexpr bool skips_lonely = true;
  static constexpr double stopped_per_step = 0.1;
  auto pair(const auto& p) const {
    const auto apart = p.i(own_normal) - p.j(other_normal);
    const auto n = (1.0 / sqrt(max(1e-300, squared_norm(apart)))) * apart;
    const auto overlaps = p.i(own_overlap) + p.j(other_overlap);
    const auto pressing = max(0.0, (-K * overlaps * (p.i(volume) * p.j(volume))) * dot(p.grad_W(), n));
    const auto v = p.i(velocity) - p.j(velocity);
    const auto sliding = v - dot(v, n) * n;
    const auto speed = sqrt(max(1e-300, squared_norm(sliding)));
    const auto inertia = p.i(mass) * p.j(mass) / (p.i(mass) + p.j(mass));
    const auto size = min(friction * pressing, (stopped_per_step / this->dt()) * inertia * speed);
    return pairs_in_contact.of(p, (-size / speed) * sliding);
  }
  void particle(auto i, auto force) const { acceleration[i] += (1.0 / mass[i]) * force; }
};

struct Contact final : Physics {
  Param<std::vector<BodyIndex>> bodies{"bodies", nullptr, "Solid bodies, each pair of which may touch.",
                                       example("[left, right]")};
  Param<std::vector<BodyIndex>> self{"self", nullptr, "Those of them that may touch themselves.", optional,
                                     example("[tube]")};
  Param<double> friction{"friction", "1", "Coulomb's coefficient of friction.", non_negative,
                         default_to(0.0)};
  Param<double> stiffness{
      "stiffness", "1",
      "Pressure of surfaces that overlap by one particle, over the smaller modulus of longitudinal "
      "waves.",
      positive, default_to(1.0)};
  Param<double> self_distance{"self_distance", "1",
                              "Particles of one body are in contact if they were further apart in the "
                              "reference configuration than this "
                              "times their spacing. Larger than the support of the contact by the factor of "
                              "the strongest compression.",
                              at_least(3.0), default_to(5.0)};

  void build(const Builder& builder);
};

}  // namespace shoal::solid
