// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "load_physics.hpp"

#include <cmath>

#include "loads.hpp"
#include "stages.hpp"

namespace shoal::solid {

void Traction::build(const Builder& b) {
  declare_loop(b);
  if (traction.is_set() == force.is_set())
    throw CaseError(
        "solid.traction needs either a traction or a force, e.g. traction: [0, \"1e4*min(t, 1)\"]");
  for (const BodyIndex body : bodies.value())
    b.attach<TractionLoad>("solid.traction", at_forces, b.target(body), [&](auto& op) {
      op.loaded.region = region_of(where, within, b.dimensions());
      op.total = force.is_set();
      op.traction = op.total ? force.value() : traction.value();
    });
}

void Pressure::build(const Builder& b) {
  declare_loop(b);
  for (const BodyIndex body : bodies.value())
    b.attach<PressureLoad>("solid.pressure_load", at_forces, b.target(body), [&](auto& op) {
      op.loaded.region = region_of(where, within, b.dimensions());
      op.pressure = pressure.value();
    });
}

void PointForce::build(const Builder& b) {
  declare_loop(b);
  for (const BodyIndex body : bodies.value())
    b.attach<PointForceLoad>("solid.point_force", at_forces, b.target(body), [&](auto& op) {
      op.point = at.value();
      op.place = at.place();
      op.radius = radius * b.body(body).spacing;
      op.force = force.value();
    });
}

void Torque::build(const Builder& b) {
  declare_loop(b);
  const std::vector<double>& direction = axis.value();
  if (direction.size() != 3) throw CaseError(axis.place() + ": the axis of a torque has three components");
  const double length = std::hypot(direction[0], direction[1], direction[2]);
  if (!(length > 0.0)) throw CaseError(axis.place() + ": the axis of a torque has no direction");
  if (b.dimensions() == 2 && (direction[0] != 0.0 || direction[1] != 0.0))
    throw CaseError(axis.place() + ": in two dimensions a torque turns about z; leave the axis out");
  for (const BodyIndex body : bodies.value())
    b.attach<TorqueLoad>("solid.torque", at_forces, b.target(body), [&](auto& op) {
      op.loaded.region = region_of(where, within, b.dimensions());
      if (b.dimensions() == 3)
        op.axis = {direction[0] / length, direction[1] / length, direction[2] / length};
      op.torque = torque.value();
    });
}

}  // namespace shoal::solid
