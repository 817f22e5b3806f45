// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// fluid.least_squares: incompressible flow without a free surface, second-order accurate in space and time.
//
//   loop advection      drift      particles move to the midpoint of the step
//                       flow
//     loop midpoint     fit        neighbours renewed, moments solved; gradients; fields carried along the shift
//                       forces     gravity, and what other plugins add to `acceleration`
//                       viscous
//       loop viscous    stage      of the super-time-stepping
//                       source     of the pressure's wave equation
//                       acoustic
//       loop acoustic   wave       pressure
//                       arrival    velocity, end of the step
#pragma once

#include "shoal/physics.hpp"

namespace shoal::fluid {

struct LeastSquares final : Physics {
  Param<std::vector<BodyIndex>> bodies{"bodies", nullptr, "Bodies of fluid, each of material fluid.liquid.",
                                       example("[water]")};
  Param<std::vector<BodyIndex>> walls{
      "walls", nullptr,
      "Bodies of material fluid.wall that bound the fluid, four layers thick. They may slide "
      "or turn with given velocities.",
      optional, example("[tank]")};
  Param<double> max_speed{"max_speed", "m/s",
                          "Largest speed that the flow will reach; with `mach` it sets the speed of sound.",
                          positive, example("1")};
  Param<double> mach{
      "mach",
      "1",
      "Speed of the flow over the speed of sound, which falls with the flow's. The error by "
      "compressibility goes with its square, the number of acoustic sub-steps with its inverse; "
      "in proportion to the resolution it keeps the second order.",
      between(1e-4, 0.5),
      default_to(0.05),
      example("2.5*dx/L")};
  Param<double> advection_cfl{
      "advection_cfl", "1", "Advection step over h / |v|.", positive, default_to(0.25), scales_time_step};
  Param<double> acoustic_cfl{
      "acoustic_cfl",
      "1",
      "Largest acoustic step over h / c. It is shorter where the stiffest fit asks for it.",
      positive,
      default_to(0.6),
      scales_time_step};
  Param<double> viscous_number{"viscous_number",
                               "1",
                               "Largest advection step over h^2 / nu. Vortices that decay fail with 1.5.",
                               positive,
                               default_to(1.0),
                               scales_time_step};
  Param<double> damping{
      "damping", "1",
      "Bulk viscosity over c dx, which damps waves of the pressure. Too little and they grow "
      "as particles move.",
      non_negative, default_to(0.2)};
  Param<double> velocity_filter{
      "velocity_filter", "1",
      "Strength of a filter that damps what particles do beyond the smooth flow around them. Take 0.1 where "
      "particles do not resolve the shear, |v| dx / nu > 10 about; 0, none, where they do: it costs "
      "accuracy. Stable "
      "below 0.8.",
      between(0.0, 0.8), default_to(0.0)};
  Param<double> shift_strength{"shift_strength", "1",
                               "Factor of the shift that keeps particles evenly spread.", non_negative,
                               default_to(0.5)};

  void build(const Builder& builder);
};

}  // namespace shoal::fluid
