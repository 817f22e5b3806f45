// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "rigid_plane.hpp"

#include "stages.hpp"
#include "wave_modulus.hpp"

namespace shoal::solid {

void RigidPlane::build(const Builder& b) {
  const Vector3 given = normal.value();
  const double length = std::hypot(given[0], given[1], given[2]);
  if (!(length > 0.0)) throw CaseError(normal.place() + ": the normal of a plane has no direction");
  declare_loop(b);
  for (const BodyIndex body : bodies.value())
    b.attach<PlaneForce>("solid.rigid_plane", at_forces, b.target(body), [&](auto& op) {
      op.point = point.value();
      op.normal = {given[0] / length, given[1] / length, given[2] / length};
      op.modulus = stiffness * wave_modulus(b, body);
      op.friction = friction;
      op.added = added_stiffness(b, body);
      *op.added += op.modulus / (b.body(body).spacing * b.body(body).spacing);
    });
}

}  // namespace shoal::solid
