// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// fluid.wcsph: weakly compressible flow with dual-criteria time stepping (Zhang, Rezavand, Hu 2020).
//
//   loop advection    shift      particles spread evenly
//                     density    re-initialised by summation, where the shift has put them
//                     geometry   of pairs, frozen for the acoustic steps (2D, in single precision)
//                     filter     velocities of particles that jitter about the flow
//                     forces     gravity, viscosity, and what other plugins add to `acceleration`
//                     acoustic
//     loop acoustic   predict    half a step of density and position, pressure
//                     momentum   pressure force
//                     kick       velocity, half a step of position
//                     continuity divergence, half a step of density
#pragma once

#include "shoal/physics.hpp"

namespace shoal::fluid {

struct Wcsph final : Physics {
  Param<std::vector<BodyIndex>> bodies{"bodies", nullptr, "Bodies of fluid, each of material fluid.liquid.",
                                       example("[water]")};
  Param<std::vector<BodyIndex>> walls{"walls", nullptr, "Bodies of material fluid.wall that bound the fluid.",
                                      optional, example("[tank]")};
  Param<double> max_speed{
      "max_speed",
      "m/s",
      "Largest speed that the flow will reach; sets the speed of sound and the first steps. Without "
      "it 2 sqrt(g H), H being the fluid's height along gravity.",
      positive,
      optional,
      example("2")};
  Param<bool> free_surface{
      "free_surface", nullptr,
      "Whether the fluid has a free surface. Without one, density is summed everywhere and "
      "particles are kept evenly spread.",
      default_to(true)};
  Param<bool> density_summation{
      "density_summation", nullptr,
      "Whether density is re-initialised by summation in each advection step, which keeps "
      "the errors of the continuity equation from adding up.",
      default_to(true)};
  Param<double> summation_tolerance{
      "summation_tolerance", "1",
      "With a free surface the density may differ by this part from that of the summation, whose noise only "
      "ever raises densities there; of what is beyond, a share is taken back in each advection step.",
      non_negative, default_to(0.01)};
  Param<double> summation_relaxation{
      "summation_relaxation", "1",
      "That share. With 1 each correction sends a sound wave through the fluid: in the 2D dam break the "
      "pressure's noise is three times that with 0.05.",
      between(0.0, 1.0), default_to(0.05)};
  Param<double> acoustic_damping{"acoustic_damping", "1",
                                 "Bulk viscosity over rho c h, which damps sound and leaves incompressible "
                                 "flow alone. The acoustic step is the shorter the larger it is.",
                                 non_negative, default_to(0.3)};
  Param<double> velocity_filter{"velocity_filter",
                                "1",
                                "Strength of the filter that damps what particles do beyond the smooth flow "
                                "around them, in every second advection step; 0: none. Without "
                                "it 0.4 with a free surface, else 0. Stable below 0.8.",
                                between(0.0, 0.8),
                                optional,
                                example("0.4")};
  Param<bool> gradient_correction{
      "gradient_correction", nullptr,
      "Whether pressure and divergence use corrected gradients. Their sums are in "
      "double precision then.",
      default_to(false)};
  Param<Choice> stabilisation{
      "stabilisation", nullptr,
      "What damps noise of the pressure. riemann: a low-dissipation Riemann solver, the most robust; take it "
      "for "
      "impacts and where in doubt. antuono: delta-SPH, diffusion of what gradients do not explain of the "
      "density; take it for waves and long calm runs, with artificial_viscosity 0.02 for impacts. fourtakas: "
      "the "
      "same against the hydrostatic density, for water that is mostly at rest. edac: diffusion of the "
      "pressure, for vortices in periodic domains and for wakes, without gravity; take density_summation: "
      "false "
      "and gradient_correction: true with it. none: only "
      "acoustic_damping, to compare.",
      one_of("riemann", "antuono", "fourtakas", "edac", "none"), default_to("riemann")};
  Param<double> diffusion{
      "diffusion",
      "1",
      "Strength of antuono and fourtakas (delta, 0.1 if not given) or of edac (alpha, 0.5 if not "
      "given).",
      non_negative,
      optional,
      example("0.1")};
  Param<double> artificial_viscosity{
      "artificial_viscosity", "1",
      "Monaghan's alpha between approaching particles, where stabilisation is not riemann: a shear viscosity "
      "of "
      "alpha c h / (2 (D + 2)). 0.02 for impacts, 0 where viscosity is resolved.",
      non_negative, default_to(0.0)};
  Param<Choice> viscous_force{"viscous_force", nullptr,
                              "morris: the usual form, most accurate in shear flows and at no-slip walls. "
                              "monaghan_gingold: forces along the line "
                              "of two particles, which keep angular momentum to rounding; take it for "
                              "viscous fluids that turn freely.",
                              one_of("morris", "monaghan_gingold"), default_to("morris")};
  Param<double> advection_cfl{
      "advection_cfl", "1", "Advection step over h / |v|.", positive, default_to(0.25), scales_time_step};
  Param<double> acoustic_cfl{
      "acoustic_cfl",
      "1",
      "Acoustic step over the longest that sound and what damps it bear, h / (c + |v|), or less where "
      "acoustic_damping or largest_dissipation are raised.",
      positive,
      default_to(0.88),
      scales_time_step};
  Param<Choice> precision{
      "precision", nullptr,
      "Of the sums over pairs in acoustic steps; particles are in double precision always. single: in some "
      "70 % of the time, with errors of some 1e-7; in 2D the geometry of pairs is frozen for each "
      "advection step. Sums with gradient_correction are in double precision.",
      one_of("single", "double"), default_to("single")};
  Param<double> dissipation_limiter{
      "dissipation_limiter", "1",
      "Factor eta of the Riemann solver's limiter min(eta (u_L - u_R) / c, 1); larger damps more.",
      non_negative, default_to(3.0)};
  Param<double> least_dissipation{
      "least_dissipation", "1",
      "Smallest factor of the Riemann solver's dissipation, from 0 (the limiter alone) to "
      "1 (an upwind scheme).",
      between(0.0, 1.0), default_to(0.0)};
  Param<double> largest_dissipation{"largest_dissipation", "1",
                                    "Largest factor of the Riemann solver's dissipation; 1 is an upwind "
                                    "scheme, for which acoustic steps are "
                                    "a third shorter.",
                                    between(0.0, 1.0), default_to(0.4)};
  Param<double> shift_strength{
      "shift_strength",
      "1",
      "Factor of the shift that keeps particles evenly spread; 0: none. Without it 0.5 "
      "where there is no free surface, else 0. With a free surface, 0.5 keeps negative "
      "pressures from tearing voids; particles at the surface move along it only.",
      non_negative,
      optional,
      example("0.5")};
  Param<bool> carry_velocity{
      "carry_velocity", nullptr,
      "Whether the shift carries velocities along, so that it does not mix momentum. One more "
      "pass in an advection step; take it for wakes and shear layers.",
      default_to(false)};

  void build(const Builder& builder);
};

}  // namespace shoal::fluid
