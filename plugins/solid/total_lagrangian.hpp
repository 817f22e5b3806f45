// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// solid.total_lagrangian: elastic and inelastic solids in the total Lagrangian description.
//
//   loop structure   drift         half a step of position
//                    half_motion   prescribed motion at the half step
//                    deformation   F, hourglass residual
//                    stress        the material's stress law
//                    forces        internal force; loads, contact and what other plugins add to `acceleration`
//                    kick          velocity, half a step of position
//                    constraints   prescribed motion at the end of the step
#pragma once

#include "solid_body.hpp"

namespace shoal::solid {

struct TotalLagrangian final : SolidPhysics {
  Param<double> damping{"damping", "1/s", "Damping of the velocity in proportion to mass, to come to rest.",
                        non_negative, default_to(0.0)};
  Param<double> viscosity{"viscosity", "Pa s", "Viscosity of the material (Kelvin-Voigt).", non_negative,
                          default_to(0.0)};
  Param<double> artificial_viscosity{
      "artificial_viscosity",
      "1",
      "Damping between neighbours in proportion to the wave speed, against noise of "
      "impacts; 0.02 removes a checkerboard.",
      non_negative,
      default_to(0.0),
      example("0.02")};
  Param<double> step_factor{
      "step_factor",   "1",          "Time step over the largest stable one of the undeformed body.",
      positive,        at_most(1.0), default_to(0.95),
      scales_time_step};

  void build(const Builder& builder);
};

}  // namespace shoal::solid
