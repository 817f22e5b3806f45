// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "shoal/plugin.hpp"
#include "body_force.hpp"
#include "least_squares/physics.hpp"
#include "liquid.hpp"
#include "open_boundary/outflow.hpp"
#include "wall_motion.hpp"
#include "wcsph.hpp"

SHOAL_PLUGIN(fluid, "0.1.0") {
  using namespace shoal::fluid;
  summary("Weakly compressible liquids with free surfaces and walls.");
  citation(
      "Zhang, Rezavand, Hu, J. Comput. Phys. 404 (2020) 109135; Zhang, Hu, Adams, J. Comput. Phys. 335 "
      "(2017) 605");
  add<Liquid>("fluid.liquid", "A weakly compressible liquid.", "Monaghan 1994");
  add<Wall>("fluid.wall", "A solid wall for fluids.", "Zhang, Hu, Adams 2017");
  add<Wcsph>("fluid.wcsph",
             "Weakly compressible flow with a low-dissipation Riemann solver and two time steps: neighbours, "
             "viscosity "
             "and gravity with the flow's speed, pressure with the speed of sound. Take it for dam breaks, "
             "sloshing, "
             "impacts, and internal flows at moderate Mach number.",
             "Zhang, Rezavand, Hu 2020");
  add<LeastSquares>(
      "fluid.least_squares",
      "Incompressible flow without a free surface, second-order accurate: derivatives by a quadratic "
      "least-squares fit, pressure by a wave equation. Take it for vortices, mixing and decay, where "
      "fluid.wcsph wants ten times the particles for the same error.",
      "Negi, Ramachandran 2022, doi:10.1016/j.cma.2022.114738");
  add<WallMotion>(
      "fluid.wall_motion",
      "Walls that move along a given path: translation and rotation as expressions of time or from a "
      "table. Take it for wave makers, rolling tanks and stirrers.");
  add<InflowPhysics>(
      "fluid.inflow",
      "A velocity given on a plane, through which new particles enter a fluid of fluid.wcsph: "
      "channels, wakes, open channels with a free surface. For flow that enters, not for tides.",
      "Lastiwka, Basa, Quinlan 2009, doi:10.1002/fld.1971");
  add<OutflowPhysics>(
      "fluid.outflow",
      "A plane through which particles leave a fluid of fluid.wcsph: against a given pressure, "
      "transparent to sound, or into nothing.",
      "Lastiwka, Basa, Quinlan 2009, doi:10.1002/fld.1971");
  add<BodyForcePhysics>("fluid.body_force", "An acceleration given by expressions of place and time.");
}
