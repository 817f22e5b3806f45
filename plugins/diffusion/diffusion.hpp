// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// diffusion.diffusion: C dc/dt = div(K grad c) + sources, for one or several fields c on one or several bodies.
//
//   loop diffusion          before     the first half of what is split off the diffusion (reactions)
//                           diffuse
//     loop diffusion_of_c_in_body  rate       everything that adds to <c>_rate
//                           update     one stage of the time integration
//                           after      the second half
//
// Reactions attach to `before` and `after`, each for half of the loop's step: Strang splitting, second order.
#pragma once

#include "medium.hpp"
#include "shoal/physics.hpp"

namespace shoal::diffusion {

struct Diffusion final : Physics {
  Param<std::vector<BodyIndex>> bodies{
      "bodies", nullptr,
      "Bodies in which the fields diffuse; through each other's surfaces where they touch.",
      example("[plate, coating]")};
  Param<std::vector<FieldName>> fields{"fields", nullptr, "Fields that diffuse, each by itself.",
                                       default_to("[temperature]"), example("[oxygen, carbon_dioxide]")};
  Param<ObjectHandle> medium{"medium",
                             nullptr,
                             "Medium of the bodies whose material is of another plugin, e.g. of a fluid that "
                             "carries the fields along.",
                             ObjectsOf{SHOAL_TYPE_MATERIAL},
                             optional,
                             example("{diffusion.medium: {diffusivity: 1e-7}}")};
  Param<Choice> scheme{
      "scheme", nullptr,
      "accurate: second order on any particles and at surfaces, for coefficients that are smooth in a body. "
      "conservative: keeps the content to rounding, and the flux continuous where coefficients jump. "
      "monotone: as "
      "accurate as far as no new extrema come into being, else with some diffusion added.",
      one_of("accurate", "conservative", "monotone"), default_to("accurate")};
  Param<bool> gradient_correction{"gradient_correction", nullptr,
                                  "Whether the conservative scheme corrects the gradient of the smoothing "
                                  "kernel: errors in insulated bodies are a "
                                  "third. Not with 'boundaries'.",
                                  default_to(false)};
  Param<std::vector<ObjectHandle>> boundaries{
      "boundaries",
      nullptr,
      "What holds at the surfaces of the bodies; the first condition whose 'where' holds counts, and where "
      "none "
      "does they are insulated.",
      ObjectsOf{SHOAL_TYPE_PHYSICS},
      optional,
      example("[diffusion.fixed_value: {where: x < 1e-6, value: 293}]")};
  Param<std::vector<Expression>> source{"source", "1",
                                        "What comes into being in the bodies: W/m3 of heat, or unit of the "
                                        "field per second; expressions of x, y, z, t, "
                                        "for all fields or one for each.",
                                        optional, example("1e5*exp(-t/10)")};
  Param<std::vector<BodyIndex>> walls{"walls", nullptr,
                                      "Bodies that keep their values of the fields, as they are given at the "
                                      "start; the surface of one is where the "
                                      "bodies see its value.",
                                      optional, example("[heated_plate]")};
  Param<std::string> inside{
      "inside", nullptr,
      "Loop and stage of another plugin in which the loop of diffusion runs, for fields that a moving body "
      "carries along.",
      optional, example("advection/forces")};
  Param<ObjectHandle> wave_speed_of{
      "wave_speed_of",
      nullptr,
      "Reaction whose plane waves shall have their right speed although the particles do not resolve the "
      "front: the "
      "coefficients are raised until they do, by an amount that vanishes with the spacing.",
      ObjectsOf{SHOAL_TYPE_MATERIAL},
      optional,
      example("{diffusion.ten_tusscher_panfilov: {cell: epi}}")};
  Param<Choice> integrator{"integrator", nullptr,
                           "rk2: Heun's method at its largest stable step. rkl2: super time steps as long as "
                           "'accuracy' allows. auto: "
                           "in each step the one that costs less.",
                           one_of("auto", "rk2", "rkl2"), default_to("auto")};
  Param<double> accuracy{
      "accuracy", "1",
      "Error that rkl2 may make by its steps in the whole run, root mean square over the range of the field.",
      between(1e-12, 0.1), default_to(1e-4)};
  Param<double> cfl{
      "cfl", "1", "Step over the largest one that is stable.", positive, default_to(0.9), scales_time_step};

  void build(const Builder& builder);
};

}  // namespace shoal::diffusion
