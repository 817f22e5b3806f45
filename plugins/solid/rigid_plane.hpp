// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// solid.rigid_plane: a rigid wall, flat and without end, that solids hit and leave again.
//
// A particle stands for the volume around it, so it touches when its centre is dx/2 before the plane. The wall presses
//   p = stiffness M x / dx,   x the depth beyond that, M the modulus of longitudinal waves,
// on the face dx^(D-1) of the particle, as stiff as the row of particles behind it. Coulomb friction as in contact.hpp.
#pragma once

#include <cmath>

#include "added_stiffness.hpp"
#include "shoal/particle_operator.hpp"
#include "shoal/physics.hpp"

namespace shoal::solid {

struct PlaneForce : ParticleOperator<PlaneForce> {
  In<Vector> position{"position"};
  In<Vector> velocity{"velocity"};
  In<Scalar> mass{"mass"};
  In<Scalar> volume{"volume"};
  Accumulate<Vector> acceleration{"acceleration"};
  Vector3 point{}, normal{};
  double modulus = 0;   // stiffness M, Pa
  double friction = 0;  // mu
  SharedStiffness added;

  void particle(auto i) const {
    constexpr int D = decltype(i)::dimensions;
    Vec<D> n{}, from{};
    for (int a = 0; a < D; ++a) {
      n[a] = normal[static_cast<std::size_t>(a)];
      from[a] = position[i][a] - point[static_cast<std::size_t>(a)];
    }
    const double depth = 0.5 * spacing() - dot(from, n);
    if (depth <= 0.0) return;
    const double pressing = modulus * depth / (spacing() * spacing()) * volume[i];
    acceleration[i] += (pressing / mass[i]) * n;
    if (friction == 0.0) return;
    const Vec<D> sliding = velocity[i] - dot(velocity[i], n) * n;
    const double speed = std::sqrt(squared_norm(sliding));
    if (speed == 0.0) return;
    const double size = std::min(friction * pressing, 0.1 * mass[i] * speed / dt());
    acceleration[i] += (-size / (mass[i] * speed)) * sliding;
  }
};

struct RigidPlane final : Physics {
  Param<std::vector<BodyIndex>> bodies{"bodies", nullptr, "Solid bodies that may hit it.", example("[bar]")};
  Param<Vector3> point{"point", "m", "A point of the plane.", example("[0, 0, 0]")};
  Param<Vector3> normal{"normal", "1", "Its normal, towards the bodies.", example("[0, 0, 1]")};
  Param<double> friction{"friction", "1", "Coulomb's coefficient of friction.", non_negative,
                         default_to(0.0)};
  Param<double> stiffness{
      "stiffness", "1",
      "Pressure on a particle that is one spacing deep, over the modulus of longitudinal waves.", positive,
      default_to(1.0)};

  void build(const Builder& builder);
};

}  // namespace shoal::solid
