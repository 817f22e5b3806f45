// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// fluid.body_force:  dv/dt = f(x, t): a central force, a stirrer, what drives a channel. Once in an advection step dt, for its
// middle, f(x + dt/2 v, t + dt/2). Kept from its beginning a force that pulls back, -B^2 x, would feed an oscillation, whose
// energy grows by the factor 1 + (B dt)^2 / 2 in each step.
#pragma once

#include <vector>

#include "shoal/particle_operator.hpp"
#include "shoal/physics.hpp"

namespace shoal::fluid {

struct BodyForce : ParticleOperator<BodyForce> {
  In<Vector> position{"position"};
  In<Vector> velocity{"velocity"};
  Accumulate<Vector> acceleration{"acceleration"};

  VectorExpression force;  // m/s2

  void block(std::uint64_t begin, std::uint64_t end) const {
    const auto d = static_cast<std::uint64_t>(dimensions());
    std::vector<double> values(end - begin), middle((end - begin) * d);
    for (std::uint64_t k = begin * d; k < end * d; ++k)
      middle[k - begin * d] = position.data()[k] + 0.5 * dt() * velocity.data()[k];
    for (std::uint64_t a = 0; a < d; ++a) {
      force.component[a].evaluate(dimensions(), end - begin, middle.data(), time() + 0.5 * dt(),
                                  values.data());
      for (std::uint64_t i = begin; i < end; ++i) acceleration.data()[i * d + a] += values[i - begin];
    }
  }
};

struct BodyForcePhysics final : Physics {
  Param<std::vector<BodyIndex>> bodies{"bodies", nullptr, "Bodies of fluid on which it acts.",
                                       example("[water]")};
  Param<VectorExpression> acceleration{"acceleration", "m/s2",
                                       "Acceleration as expressions of x, y, z and t.", example("[-x, -y]")};

  void build(const Builder& b) {
    for (const BodyIndex body : bodies.value())
      b.attach<BodyForce>("fluid.body_force", {"advection", "forces"}, b.target(body),
                          [&](BodyForce& op) { op.force = acceleration; });
  }
};

}  // namespace shoal::fluid
