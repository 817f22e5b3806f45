// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// solid.quasi_static: solids at rest under their loads, by damped relaxation (relaxation.hpp). The discretisation is
// that of solid.total_lagrangian, with its loop; inertia and the time step are made up. Time t only says how far loads
// and prescribed motions that are expressions of it have come: one iteration is 1/`iterations` of the run, which ends
// by itself as soon as the body rests. Constraints must keep it from moving as a whole, also where loads are in balance.
//
//   loop structure   half_motion, deformation, stress, forces   as in total_lagrangian.hpp
//                    kick          out-of-balance force, one step of the relaxation
//                    constraints   prescribed motion
#pragma once

#include "solid_body.hpp"

namespace shoal::solid {

struct QuasiStatic final : SolidPhysics {
  Param<double> tolerance{
      "tolerance",
      "1",
      "Out-of-balance force at which the body counts as at rest and the run ends: its norm over all "
      "particles that "
      "are free to move, over the sum of the norms of the internal force and of the loads.",
      positive,
      below(1.0),
      default_to(1e-6)};
  Param<std::int64_t> iterations{
      "iterations", "1",
      "Most iterations; as many steps make the time of the run. Not to be at rest by then "
      "is an error.",
      at_least(2.0), default_to(2000)};
  Param<double> loaded_at{
      "loaded_at", "s",
      "Time from which loads and prescribed motions stay as they are: no rest counts before.", non_negative,
      default_to(0.0)};
  Param<Choice> mass{"mass", nullptr,
                     "Mass matrix of the relaxation. stiffness: that of the body, factorised: some ten "
                     "iterations. bonds: of springs "
                     "between neighbours, with less memory in 3D: some hundred iterations. lumped: a mass "
                     "for each particle: as many "
                     "as waves need to cross the body many times. automatic: stiffness below 200 000 "
                     "particles in 2D and 2500 in 3D, "
                     "bonds below 20 000 in 3D, else lumped.",
                     one_of("automatic", "stiffness", "bonds", "lumped"), default_to("automatic")};

  void build(const Builder& builder);
};

}  // namespace shoal::solid
