// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "shoal/plugin.hpp"
#include "constraints.hpp"
#include "load_physics.hpp"
#include "point_probe.hpp"
#include "total_lagrangian.hpp"
#include "tmp_material.hpp"

SHOAL_PLUGIN(solid, "0.1.0") {
  using namespace shoal::solid;
  summary("Elastic and inelastic solids at large deformation.");
  add<TotalLagrangian>("solid.total_lagrangian",
                       "Solids in the total Lagrangian description, with a gradient of second order, hourglass control, "
                       "and exact conservation of momentum, angular momentum and energy.",
                       "after Bonet, Lok 1999; Ganzenmueller 2015; Zhang, Rezavand, Hu 2021");
  add<TmpLaw>("solid.tmp", "tmp");
  add<Clamp>("solid.clamp", "Particles that are held where they are, or in some directions only.");
  add<PrescribedMotionPhysics>("solid.prescribed_motion", "Particles whose displacement or velocity is given.");
  add<Traction>("solid.traction", "Force per area on a flat face of a body, in a fixed direction.");
  add<Pressure>("solid.pressure", "Pressure on the surface of a body, which follows it as it deforms.");
  add<PointForce>("solid.point_force", "A force on the particles around a point.");
  add<Torque>("solid.torque", "A torque on a part of a body.");
  add<PointProbe>("solid.point", "Displacement of a point of the body, on its surface too.");
}
