// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "shoal/plugin.hpp"
#include "constraints.hpp"
#include "contact.hpp"
#include "load_physics.hpp"
#include "materials/guccione.hpp"
#include "materials/holzapfel_ogden.hpp"
#include "materials/johnson_cook.hpp"
#include "materials/mooney_rivlin.hpp"
#include "materials/neo_hookean.hpp"
#include "materials/orthotropic.hpp"
#include "materials/plastic.hpp"
#include "materials/st_venant_kirchhoff.hpp"
#include "point_probe.hpp"
#include "quasi_static.hpp"
#include "rigid_plane.hpp"
#include "total_lagrangian.hpp"

SHOAL_PLUGIN(solid, "0.1.0") {
  using namespace shoal::solid;
  summary("Elastic and inelastic solids at large deformation.");
  citation(
      "Zhang, Rezavand, Hu, J. Comput. Phys. 429 (2021) 110028; Bonet, Lok, Comput. Methods Appl. Mech. Eng. "
      "180 "
      "(1999) 97");

  add<StVenantKirchhoff>("solid.st_venant_kirchhoff",
                         "Linear in the Green-Lagrange strain: for large rotations at small strains.");
  add<NeoHookean>("solid.neo_hookean", "Rubber at moderate strains.", "Simo, Taylor 1982; Bonet, Wood 2008");
  add<MooneyRivlin>("solid.mooney_rivlin", "Rubber with two constants.", "Mooney 1940; Rivlin 1948");
  add<Orthotropic>("solid.orthotropic", "Different stiffness along three axes.");
  add<HolzapfelOgden>("solid.holzapfel_ogden", "Passive heart muscle with fibres and sheets.",
                      "Holzapfel, Ogden 2009, doi:10.1098/rsta.2009.0091");
  add<Guccione>("solid.guccione", "Passive heart muscle, transversely isotropic.",
                "Guccione, McCulloch, Waldman 1991");
  add<Plastic>("solid.plastic", "Metal with isotropic hardening, linear or after Voce.", "Simo, Hughes 1998");
  add<JohnsonCook>("solid.johnson_cook", "Metal whose yield stress depends on strain and its rate.",
                   "Johnson, Cook 1983");

  add<TotalLagrangian>(
      "solid.total_lagrangian",
      "Solids in the total Lagrangian description, with a gradient of second order, hourglass control, "
      "and exact conservation of momentum, angular momentum and energy.",
      "after Bonet, Lok 1999; Ganzenmueller 2015; Zhang, Rezavand, Hu 2021");
  add<QuasiStatic>(
      "solid.quasi_static",
      "Solids at rest under their loads, by damped relaxation with automatic damping; the run ends by "
      "itself at rest.",
      "after Underwood 1983; Oakley, Knight 1995");
  add<Clamp>("solid.clamp", "Particles that are held where they are, or in some directions only.");
  add<PrescribedMotionPhysics>("solid.prescribed_motion",
                               "Particles whose displacement or velocity is given.");
  add<Traction>("solid.traction", "Force per area on a flat face of a body, in a fixed direction.");
  add<Pressure>("solid.pressure", "Pressure on the surface of a body, which follows it as it deforms.");
  add<PointForce>("solid.point_force", "A force on the particles around a point.");
  add<Torque>("solid.torque", "A torque on a part of a body.");
  add<Contact>("solid.contact", "Bodies that touch each other or themselves, with friction.");
  add<RigidPlane>("solid.rigid_plane", "A flat rigid wall that solids hit and leave again, with friction.");
  add<PointProbe>("solid.point", "Displacement of a point of the body, on its surface too.");
}
