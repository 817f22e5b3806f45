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

#include "shoal/physics.hpp"

namespace shoal::solid {

struct TotalLagrangian final : Physics {
  Param<std::vector<BodyIndex>> bodies{
      "bodies", nullptr, "Solid bodies, each with a material that has a stress law.", example("[beam]")};
  Param<Choice> plane{
      "plane", nullptr,
      "In two dimensions: whether the body is thick (plane strain) or a thin sheet (plane stress).",
      one_of("strain", "stress"), default_to("strain")};
  Param<Choice> gradient{
      "gradient", nullptr,
      "quadratic: least-squares fit of second order. linear: the correction matrix of Bonet and Lok, which "
      "loses "
      "bending stress at surfaces (Turek and Hron's CSM1 at 8 particles across: 7 % against 1 %).",
      one_of("quadratic", "linear"), default_to("quadratic")};
  Param<double> support{"support", "1",
                        "Radius of the reference neighbourhood over the distance of the particles.",
                        between(1.8, 4.0), default_to(2.3)};
  Param<double> regularisation{
      "regularisation", "1",
      "Of the quadratic terms of the fit: more allows larger steps on disordered particles, "
      "less is more accurate.",
      non_negative, default_to(0.01)};
  Param<bool> consistent{
      "consistent", nullptr,
      "Whether the weights of disordered particles are changed so that a uniform stress exerts no "
      "force inside the body; a lattice needs no change.",
      default_to(true)};
  Param<double> hourglass{
      "hourglass", "1",
      "Strength of the control of modes that alternate between particles, over the shear modulus; "
      "0: none.",
      non_negative, default_to(5.0)};
  Param<Choice> average_volume{"average_volume", nullptr,
                               "Whether the volumetric part of the energy takes the mean volume ratio of a "
                               "neighbourhood, which keeps the "
                               "pressure of nearly incompressible materials smooth; automatic: where the "
                               "bulk modulus is more than ten times the "
                               "shear modulus (Poisson's ratio above 0.452).",
                               one_of("automatic", "always", "never"), default_to("automatic")};
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
      "step_factor", "1",          "Time step over the largest stable one of the undeformed body.",
      positive,      at_most(1.0), default_to(0.8)};

  void build(const Builder& builder);
};

}  // namespace shoal::solid
